// Image files by OpenImageIO: a module beside the library, or a part of it where that is static.
#include "core/image_library.h"

#include "image_modules.h"
#include "stored_pixels.h"

#include <bandvox/core/error.h>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>

namespace bandvox {

namespace {

// Rows that are encoded at a time. The picture is there once already, and another copy of it could
// be more than the memory holds.
constexpr int kStripRows = 64;

// A picture may not be larger than this, pixels.
constexpr std::int64_t kMostPixels = std::int64_t(1) << 30;

// Takes what an encoder writes to a stream, and keeps what the disk has said about it.
class StreamProxy final : public OIIO::Filesystem::IOProxy {
  public:
    explicit StreamProxy(std::ostream& stream) : IOProxy("", Write), mStream(stream) {}

    const char* proxytype() const override { return "stream"; }
    bool seek(std::int64_t offset) override {
        m_pos = offset;
        return noted(static_cast<bool>(mStream.seekp(offset)));
    }
    std::size_t write(const void* bytes, std::size_t size) override {
        m_pos += static_cast<std::int64_t>(size);
        if (mIsAbandoned) {
            mHasLeftOut = true;
            return size;
        }
        return noted(static_cast<bool>(mStream.write(static_cast<const char*>(bytes),
                                                     static_cast<std::streamsize>(size))))
                   ? size
                   : 0;
    }
    void flush() const override { mStream.flush(); }

    // Leaves out what is written from now on, as of a picture that is given up.
    void abandon() { mIsAbandoned = true; }
    bool hasLeftOut() const { return mHasLeftOut; }

    // What went wrong first; 0 if nothing did.
    int failure() const { return mFailure; }

  private:
    bool noted(bool good) {
        if (!good && mFailure == 0) mFailure = errno;
        return good;
    }

    std::ostream& mStream;
    int mFailure = 0;
    bool mIsAbandoned = false;
    bool mHasLeftOut = false;
};

constexpr const char* kLinear = "linear";
constexpr const char* kCoded = "sRGB";

// The configuration that the environment names, else what is built in.
class ColorConfiguration {
  public:
    ColorConfiguration() {
        // What fails falls back to what is built in, and keeps why; a file of raw data alone does
        // not.
        std::string why = mConfig.geterror();
        if (why.empty() && mConfig.configname() == "built-in") why = "it knows raw data alone";
        if (why.empty()) {
            mConfig.createColorProcessor(kLinear, kCoded);
            why = mConfig.geterror();
        }
        const char* const name = std::getenv("OCIO");
        if (name == nullptr || *name == '\0' || why.empty()) return;
        std::ostringstream fault;
        fault << "'" << name
              << "', which the variable OCIO names, is no colour configuration that a .png can be "
                 "written by ("
              << why << "); it is written by the sRGB that is built in";
        mFault = fault.str();
    }

    // From one colour space to another, if the configuration knows both.
    OIIO::ColorProcessorHandle processor(const char* from, const char* to) const {
        return mConfig.createColorProcessor(from, to);
    }

    // Why the one that the environment names is not used; empty if it is.
    const std::string& fault() const { return mFault; }

  private:
    OIIO::ColorConfig mConfig;
    std::string mFault;
};

const ColorConfiguration& colorConfiguration() {
    static const ColorConfiguration configuration;
    return configuration;
}

// Changes the colours of pixels in place; alpha stays.
void convertColors(std::vector<float>& pixels, const OIIO::ImageSpec& spec, const char* from,
                   const char* to) {
    const OIIO::ColorProcessorHandle processor = colorConfiguration().processor(from, to);
    if (!processor) {
        throw Error(ErrorKind::Runtime,
                    std::string("OpenImageIO's colour configuration (see the variable OCIO) has no "
                                "way from ") +
                        from + " to " + to);
    }
    OIIO::ImageBuf image(spec, pixels.data());
    if (!OIIO::ImageBufAlgo::colorconvert(image, image, processor.get(), /*unpremult=*/false)) {
        throw Error(ErrorKind::Runtime, image.geterror());
    }
}

std::uint8_t eightBits(float value) {
    // Also takes what is not a number, as 0.
    return static_cast<std::uint8_t>(std::lround(255 * (value > 0 ? std::min(value, 1.0F) : 0)));
}

// Gives up a picture of which the rows from `top` on are missing. libpng says on the standard
// error, however it is closed, that nothing came of a file of which it holds all rows back: it gets
// black ones until it puts some out.
void giveUp(OIIO::ImageOutput& output, StreamProxy& proxy, const PngRows& image, int top) {
    proxy.abandon();
    const std::vector<std::uint8_t> black(4 * static_cast<std::size_t>(image.width) * kStripRows);
    while (top < image.height && !proxy.hasLeftOut()) {
        const int bottom = std::min(top + kStripRows, image.height);
        if (!output.write_scanlines(top, bottom, 0, OIIO::TypeDesc::UINT8, black.data())) return;
        top = bottom;
    }
}

bool writeStrips(OIIO::ImageOutput& output, StreamProxy& proxy, const PngRows& image) {
    std::vector<float> pixels;
    std::vector<std::uint8_t> bytes;
    for (int top = 0; top < image.height; top += kStripRows) {
        const int bottom = std::min(top + kStripRows, image.height);
        pixels.resize(4 * static_cast<std::size_t>(image.width) * (bottom - top));
        try {
            image.rows(top, bottom, pixels);
            const OIIO::ImageSpec spec(image.width, bottom - top, 4, OIIO::TypeDesc::FLOAT);
            convertColors(pixels, spec, kLinear, kCoded);
        } catch (...) {
            giveUp(output, proxy, image, top);
            throw;
        }
        bytes.resize(pixels.size());
        std::transform(pixels.begin(), pixels.end(), bytes.begin(), eightBits);
        if (!output.write_scanlines(top, bottom, 0, OIIO::TypeDesc::UINT8, bytes.data())) {
            return false;
        }
    }
    return true;
}

// Returns what went wrong, or nothing.
std::string encode(const PngRows& image, StreamProxy& proxy) {
    OIIO::ImageSpec spec(image.width, image.height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    OIIO::Filesystem::IOProxy* pointer = &proxy;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &pointer);
    const auto output = OIIO::ImageOutput::create("picture.png", &proxy);
    if (!output) return OIIO::geterror();
    if (!output->supports("ioproxy")) return "OpenImageIO cannot write it through this library";
    if (!output->open("picture.png", spec) || !writeStrips(*output, proxy, image) ||
        !output->close()) {
        return output->geterror();
    }
    return {};
}

class OpenImageIo final : public ImageLibrary {
  public:
    PixelArray read(const std::filesystem::path& path) const override {
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) fail(path.string(), "there is no such file");
        requireSound(path, path.string() + ": ");
        return read(path.string(), nullptr, lengthOf(path));
    }

    PixelArray read(std::span<const std::byte> bytes, const std::string& name) const override {
        requireSound(bytes, name + ": ");
        OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
        return read(name, &memory, double(bytes.size()));
    }

    CodedPixels readCoded(const std::filesystem::path& path,
                          const PixelGuard& guard) const override {
        requireSound(path, "cannot be read: ");
        const OIIO::ImageSpec config = unmultiplied();
        return readCoded(OIIO::ImageInput::open(path.string(), &config).get(), lengthOf(path),
                         guard);
    }

    CodedPixels readCoded(std::span<const std::byte> bytes, const std::string& name,
                          const PixelGuard& guard) const override {
        requireSound(bytes, "cannot be read: ");
        OIIO::ImageSpec config = unmultiplied();
        OIIO::Filesystem::IOMemReader reader(bytes.data(), bytes.size());
        OIIO::Filesystem::IOProxy* proxy = &reader;
        config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        return readCoded(OIIO::ImageInput::open(name, &config).get(), double(bytes.size()), guard);
    }

    std::string colorFault() const override { return colorConfiguration().fault(); }

    WriteFailure writePng(std::ostream& stream, const PngRows& image) const override {
        StreamProxy proxy(stream);
        const std::string failure = encode(image, proxy);
        return {failure, proxy.failure()};
    }

    std::unique_ptr<SliceFile> openSlices(const std::filesystem::path& path,
                                          int threads) const override {
        return openSliceFile(path, threads);
    }

    std::unique_ptr<SliceOutput> createSlices(const std::filesystem::path& path,
                                              const SliceOutputInfo& info) const override {
        return createSliceFile(path, info);
    }

    std::unique_ptr<DicomFile> openDicom(const std::filesystem::path& path) const override {
        return openDicomFile(path);
    }

  private:
    // Colours that are multiplied with alpha would be darker than they are.
    static OIIO::ImageSpec unmultiplied() {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);
        return config;
    }

    static CodedPixels readCoded(OIIO::ImageInput* input, double length, const PixelGuard& guard) {
        if (!input) throw Error(ErrorKind::Input, "cannot be read: " + OIIO::geterror());
        const OIIO::ImageSpec& spec = input->spec();
        if (spec.depth > 1 || spec.deep || spec.nchannels < 1 || spec.width < 1 ||
            spec.height < 1) {
            throw Error(ErrorKind::Input,
                        "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                            " x " + std::to_string(spec.depth) + " texels of " +
                            std::to_string(spec.nchannels) + " channels; expected a flat picture");
        }
        if (const std::string why = excess(*input, length); !why.empty()) {
            throw Error(ErrorKind::Input, why);
        }
        guard(spec.width, spec.height, 2.0 * static_cast<double>(spec.image_bytes(true)));
        CodedPixels pixels{spec.width,
                           spec.height,
                           spec.nchannels >= 3 ? 3 : 1,
                           spec.format.is_floating_point(),
                           {}};
        if (!readPixels(*input, spec, 0, 0, pixels.channels, OIIO::TypeDesc::UINT16,
                        pixels.values)) {
            throw Error(ErrorKind::Input, "cannot be read: " + input->geterror());
        }
        return pixels;
    }

    // Says what is wrong if a file of so many bytes cannot hold what it claims.
    static std::string excess(const OIIO::ImageInput& input, double length) {
        const OIIO::ImageSpec& spec = input.spec();
        if (static_cast<double>(spec.image_bytes(true)) <= length * mostPacked(input, spec)) {
            return {};
        }
        std::string why = "claims " + std::to_string(spec.width) + " x ";
        why += std::to_string(spec.height) + " pixels of ";
        why += std::to_string(spec.nchannels) + " channels; expected what its ";
        return why + std::to_string(static_cast<long long>(length)) + " bytes can hold";
    }

    template <typename File>
    static void requireSound(const File& file, const std::string& before) {
        try {
            requireSoundImage(file);
        } catch (const Error& error) {
            throw Error(ErrorKind::Input, before + error.what());
        }
    }

    [[noreturn]] static void fail(const std::string& name, const std::string& why) {
        throw Error(ErrorKind::Input, name + ": " + why);
    }

    static PixelArray read(const std::string& name, OIIO::Filesystem::IOProxy* proxy,
                           double length) {
        const auto input = OIIO::ImageInput::open(name, nullptr, proxy);
        if (!input) fail(name, "it is no image that can be read (" + OIIO::geterror() + ")");
        const OIIO::ImageSpec& spec = input->spec();
        const std::int64_t pixels = std::int64_t(spec.width) * spec.height;
        if (spec.depth > 1 || spec.deep || pixels < 1 || pixels > kMostPixels ||
            spec.nchannels < 1) {
            fail(name, "it holds " + std::to_string(spec.width) + " x " +
                           std::to_string(spec.height) + " x " + std::to_string(spec.depth) +
                           " pixels of " + std::to_string(spec.nchannels) +
                           " channels; expected a picture");
        }
        if (const std::string why = excess(*input, length); !why.empty()) fail(name, "it " + why);
        PixelArray image{spec.width, spec.height, std::min(spec.nchannels, 4), {}};
        if (!readPixels(*input, spec, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.values)) {
            fail(name, "it cannot be read to its end (" + input->geterror() + ")");
        }
        // 8 and 16 bits that say nothing of their colours are sRGB.
        const std::string space = spec.get_string_attribute("oiio:ColorSpace");
        const bool isInteger = !spec.format.is_floating_point();
        if (space == "sRGB" || (space.empty() && isInteger)) {
            const OIIO::ImageSpec floats(image.width, image.height, image.channels,
                                         OIIO::TypeDesc::FLOAT);
            convertColors(image.values, floats, kCoded, kLinear);
        }
        return image;
    }
};

}  // namespace

extern "C" const ImageLibrary* bandvoxImageLibrary() {
    static const OpenImageIo library;
    return &library;
}

}  // namespace bandvox
