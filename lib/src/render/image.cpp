#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/render/image.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace bandvox {

namespace {

// The extension, lower case with the dot.
std::string extensionOf(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
    throw Error(ErrorKind::Runtime, "cannot write " + path.string() + ": " + why);
}

[[noreturn]] void failExtension(const std::filesystem::path& path) {
    throw Error(ErrorKind::Usage, "cannot write " + path.string() + ": the extension is \"" +
                                      path.extension().string() + "\"; expected .png or .exr");
}

std::size_t pixelCount(const Image& image) {
    return static_cast<std::size_t>(image.width) * image.height;
}

void requireChannel(const std::vector<float>& channel, std::size_t expected, const char* name) {
    if (channel.size() == expected) return;
    throw Error(ErrorKind::Usage, std::string("an image's ") + name + " holds " +
                                      std::to_string(channel.size()) + " numbers; expected " +
                                      std::to_string(expected));
}

void requireComplete(const Image& image) {
    if (image.width < 1 || image.height < 1) {
        throw Error(ErrorKind::Usage, "an image of " + std::to_string(image.width) + " x " +
                                          std::to_string(image.height) +
                                          " pixels; expected at least 1 x 1");
    }
    const std::size_t pixels = pixelCount(image);
    requireChannel(image.color, 4 * pixels, "color");
    requireChannel(image.depth, pixels, "depth");
    requireChannel(image.normal, 3 * pixels, "normal");
    requireChannel(image.position, 3 * pixels, "position");
}

// IEC 61966-2-1, the transfer curve of sRGB.
double srgbOfLinear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t eightBits(double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

// Rows that are encoded at a time, whole blocks of every encoder. The picture is there once
// already, and another copy of it could be more than the memory holds.
constexpr int kStripRows = 64;

// The pixels [begin, end) in sRGB with alpha beside it, four bytes a pixel.
std::vector<std::uint8_t> srgbPixels(const Image& image, std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> pixels;
    pixels.reserve(4 * (end - begin));
    for (std::size_t p = 4 * begin; p < 4 * end; p += 4) {
        const double alpha = image.color[p + 3];
        for (int c = 0; c < 3; ++c) {
            const double linear = alpha > 0 ? image.color[p + c] / alpha : 0;
            pixels.push_back(eightBits(srgbOfLinear(std::max(linear, 0.0))));
        }
        pixels.push_back(eightBits(alpha));
    }
    return pixels;
}

// All channels of the pixels [begin, end) side by side, in the order of exrSpec.
std::vector<float> dataPixels(const Image& image, std::size_t begin, std::size_t end) {
    std::vector<float> data;
    data.reserve(11 * (end - begin));
    for (std::size_t p = begin; p < end; ++p) {
        data.insert(data.end(), &image.color[4 * p], &image.color[4 * p] + 4);
        data.push_back(image.depth[p]);
        data.insert(data.end(), &image.normal[3 * p], &image.normal[3 * p] + 3);
        data.insert(data.end(), &image.position[3 * p], &image.position[3 * p] + 3);
    }
    return data;
}

OIIO::ImageSpec pngSpec(const Image& image) {
    OIIO::ImageSpec spec(image.width, image.height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return spec;
}

OIIO::ImageSpec exrSpec(const Image& image) {
    OIIO::ImageSpec spec(image.width, image.height, 11, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"};
    spec.channelformats.assign(11, OIIO::TypeDesc::FLOAT);
    std::fill_n(spec.channelformats.begin(), 4, OIIO::TypeDesc::HALF);
    spec.alpha_channel = 3;
    spec.z_channel = 4;
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("compression", "zip");
    return spec;
}

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
        return noted(static_cast<bool>(mStream.write(static_cast<const char*>(bytes),
                                                     static_cast<std::streamsize>(size))))
                   ? size
                   : 0;
    }
    void flush() const override { mStream.flush(); }

    // What went wrong first; 0 if nothing did.
    int failure() const { return mFailure; }

  private:
    bool noted(bool good) {
        if (!good && mFailure == 0) mFailure = errno;
        return good;
    }

    std::ostream& mStream;
    int mFailure = 0;
};

OIIO::ImageSpec specOf(const Image& image, bool png) {
    OIIO::ImageSpec spec = png ? pngSpec(image) : exrSpec(image);
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    return spec;
}

bool writeStrips(OIIO::ImageOutput& output, const Image& image, bool png, Progress& progress) {
    for (int top = 0; top < image.height; top += kStripRows) {
        progress.throwIfInterrupted();
        const int bottom = std::min(top + kStripRows, image.height);
        const std::size_t begin = static_cast<std::size_t>(top) * image.width;
        const std::size_t end = static_cast<std::size_t>(bottom) * image.width;
        const bool good = png ? output.write_scanlines(top, bottom, 0, OIIO::TypeDesc::UINT8,
                                                       srgbPixels(image, begin, end).data())
                              : output.write_scanlines(top, bottom, 0, OIIO::TypeDesc::FLOAT,
                                                       dataPixels(image, begin, end).data());
        if (!good) return false;
    }
    return true;
}

// Returns what went wrong, or nothing.
std::string encode(const std::string& name, const Image& image, OIIO::Filesystem::IOProxy& proxy,
                   Progress& progress) {
    const bool png = extensionOf(name) == ".png";
    OIIO::ImageSpec spec = specOf(image, png);
    OIIO::Filesystem::IOProxy* pointer = &proxy;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &pointer);
    const auto output = OIIO::ImageOutput::create(name, &proxy);
    if (!output) return OIIO::geterror();
    if (!output->supports("ioproxy")) return "OpenImageIO cannot write it through this library";
    if (!output->open(name, spec) || !writeStrips(*output, image, png, progress) ||
        !output->close()) {
        return output->geterror();
    }
    return {};
}

}  // namespace

bool isImageFile(const std::filesystem::path& path) {
    const std::string extension = extensionOf(path);
    return extension == ".png" || extension == ".exr";
}

void writeImage(AtomicFile& file, const Image& image, Progress& progress) {
    const std::filesystem::path& path = file.target();
    if (!isImageFile(path)) failExtension(path);
    requireComplete(image);
    std::ofstream stream = file.open();
    std::string failure;
    int diskFailure = 0;
    if (file.inPlace()) {
        // An encoder goes back to fill in what it knows at the end.
        std::vector<unsigned char> bytes;
        OIIO::Filesystem::IOVecOutput memory(bytes);
        failure = encode(path.string(), image, memory, progress);
        stream.write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
    } else {
        StreamProxy proxy(stream);
        failure = encode(path.string(), image, proxy, progress);
        diskFailure = proxy.failure();
    }
    if (diskFailure == 0) {
        errno = 0;
        stream.close();
        if (!stream) diskFailure = errno;
    }
    // What the disk says comes before what an encoder makes of it.
    if (diskFailure != 0) fail(path, std::strerror(diskFailure));
    if (!failure.empty() || !stream) fail(path, failure.empty() ? "unknown failure" : failure);
}

void writeImage(const std::filesystem::path& path, const Image& image) {
    if (!isImageFile(path)) failExtension(path);
    requireComplete(image);
    AtomicFile file(path);
    writeImage(file, image);
    file.commit();
}

}  // namespace bandvox
