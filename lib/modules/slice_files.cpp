// Images as they are stored, by OpenImageIO.
#include "core/slice_files.h"

#include "image_modules.h"
#include "stored_pixels.h"

#include <bandvox/core/error.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

namespace {

// No file has as many pages.
constexpr int kMostPages = 1 << 20;

// Of zlib: more takes far longer, and makes scans, which are mostly noise, hardly smaller.
constexpr int kPackingLevel = 3;

std::string typeName(const OIIO::TypeDesc& type) {
    switch (type.basetype) {
        case OIIO::TypeDesc::UINT8:
            return "uint8";
        case OIIO::TypeDesc::INT8:
            return "int8";
        case OIIO::TypeDesc::UINT16:
            return "uint16";
        case OIIO::TypeDesc::INT16:
            return "int16";
        case OIIO::TypeDesc::UINT32:
            return "uint32";
        case OIIO::TypeDesc::INT32:
            return "int32";
        case OIIO::TypeDesc::HALF:
            return "float16";
        case OIIO::TypeDesc::FLOAT:
            return "float32";
        case OIIO::TypeDesc::DOUBLE:
            return "float64";
        default:
            throw Error(ErrorKind::Input,
                        std::string("its values are of type ") + type.c_str() +
                            "; expected whole numbers of 8 to 32 bits, half, float or double");
    }
}

OIIO::TypeDesc typeOfName(const std::string& name) {
    using OIIO::TypeDesc;
    for (const auto type : {TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::INT16, TypeDesc::HALF,
                            TypeDesc::FLOAT, TypeDesc::DOUBLE}) {
        if (typeName(type) == name) return type;
    }
    throw Error(ErrorKind::Runtime, "values of type " + name + " are not written to images");
}

OIIO::ImageSpec asStored() {
    OIIO::ImageSpec config;
    // Neither multiply with alpha nor turn other colours to red, green and blue.
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:RawColor", 1);
    return config;
}

class OpenImageIoSlices final : public SliceFile {
  public:
    OpenImageIoSlices(const std::filesystem::path& path, int threads) {
        requireSoundImage(path);
        const OIIO::ImageSpec config = asStored();
        mInput = OIIO::ImageInput::open(path.string(), &config);
        if (!mInput) {
            throw Error(ErrorKind::Input,
                        "it is no image that can be read (" + OIIO::geterror() + ")");
        }
        mInput->threads(threads);
        mSpec = mInput->spec();
        requireFlat(mSpec);
        mInfo.width = mSpec.width;
        mInfo.height = mSpec.height;
        mInfo.channels = mSpec.channelnames;
        mInfo.type = typeName(mSpec.format);
        const int wide = static_cast<int>(8 * mSpec.format.size());
        mInfo.bits = std::clamp(mSpec.get_int_attribute("oiio:BitsPerSample", wide), 1, wide);
        mInfo.description = mSpec.get_string_attribute("ImageDescription");
        mInfo.resolution = {mSpec.get_float_attribute("XResolution"),
                            mSpec.get_float_attribute("YResolution")};
        mInfo.pageBytes = bytesOfPage(mSpec);
        mInfo.mostPacked = mostPacked(*mInput, mSpec);
        mInfo.pages = countPages();
    }

    void read(int page, int firstChannel, int channels, std::vector<char>& values) override {
        // Where a page lies may be its own.
        OIIO::ImageSpec spec = mSpec;
        spec.copy_dimensions(mInput->spec_dimensions(page));
        mInput->geterror();
        if (!readPixels(*mInput, spec, page, firstChannel, channels, mSpec.format, values) ||
            mInput->has_error()) {
            // Of strips that are cut off there may only be a word, and one for each.
            const std::string why = mInput->geterror();
            throw Error(ErrorKind::Input,
                        "it cannot be read to its end (" + why.substr(0, why.find('\n')) + ")");
        }
    }

  private:
    static void requireFlat(const OIIO::ImageSpec& spec) {
        if (spec.depth <= 1 && !spec.deep && spec.nchannels >= 1 && spec.width >= 1 &&
            spec.height >= 1 && spec.channelformats.empty()) {
            return;
        }
        throw Error(ErrorKind::Input,
                    "it holds " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                        " x " + std::to_string(spec.depth) + " pixels of " +
                        std::to_string(spec.nchannels) + " channels" +
                        (spec.deep ? ", several to a pixel" : "") +
                        (spec.channelformats.empty() ? "" : " of different types") +
                        "; expected flat images of one type");
    }

    // With the tiles that it is read by, which may reach beyond it.
    static double bytesOfPage(const OIIO::ImageSpec& spec) {
        double width = spec.width, height = spec.height;
        if (spec.tile_width > 0 && spec.tile_height > 0) {
            width = std::max<double>(width, spec.tile_width);
            height = std::max<double>(height, spec.tile_height);
        }
        return width * height * spec.nchannels * static_cast<double>(spec.format.size());
    }

    // Throws unless all pages are as the first.
    int countPages() {
        int pages = 1;
        while (pages < kMostPages && mInput->seek_subimage(pages, 0)) {
            const OIIO::ImageSpec spec = mInput->spec_dimensions(pages);
            if (spec.width != mSpec.width || spec.height != mSpec.height ||
                spec.nchannels != mSpec.nchannels || spec.format != mSpec.format) {
                throw Error(ErrorKind::Input, "page " + std::to_string(pages) + " holds " +
                                                  inWords(spec) + ", and page 0 " + inWords(mSpec) +
                                                  "; expected the same");
            }
            ++pages;
        }
        // That there is no other page is no failure, whatever is said of it.
        mInput->geterror();
        return pages;
    }

    static std::string inWords(const OIIO::ImageSpec& spec) {
        std::string text = std::to_string(spec.width) + " x " + std::to_string(spec.height);
        text += " pixels of " + std::to_string(spec.nchannels) + " x ";
        text += spec.format.c_str();
        return text;
    }

    std::unique_ptr<OIIO::ImageInput> mInput;
    OIIO::ImageSpec mSpec;
};

class OpenImageIoOutput final : public SliceOutput {
  public:
    OpenImageIoOutput(const std::filesystem::path& path, const SliceOutputInfo& info)
        : mPath(path.string()),
          mSpec(info.width, info.height, 1, typeOfName(info.type)),
          mOutput(OIIO::ImageOutput::create("slices" + info.extension)) {
        if (!mOutput) throw Error(ErrorKind::Runtime, OIIO::geterror());
        mOutput->threads(info.threads);
        // The library's writer of .png files says nothing of a disk that is full: it writes to
        // memory.
        if (info.extension == ".png") mBytes.emplace();
        mSpec.channelnames = {"Y"};
        // What is written are numbers, not colours.
        mSpec.attribute("oiio:ColorSpace", "Linear");
        mSpec.attribute("png:compressionLevel", kPackingLevel);
        mSpec.attribute("tiff:zipquality", kPackingLevel);
        if (info.extension != ".png") {
            mSpec.attribute("compression", info.compress ? "zip" : "none");
        }
        if (info.large) mSpec.attribute("tiff:bigtiff", 1);
        if (!info.description.empty()) mSpec.attribute("ImageDescription", info.description);
        if (info.resolution[0] > 0 && info.resolution[1] > 0) {
            mSpec.attribute("XResolution", static_cast<float>(info.resolution[0]));
            mSpec.attribute("YResolution", static_cast<float>(info.resolution[1]));
            mSpec.attribute("ResolutionUnit", "none");
            // Otherwise both are written as the first.
            mSpec.attribute("PixelAspectRatio",
                            static_cast<float>(info.resolution[1] / info.resolution[0]));
        }
    }

    void write(const char* values) override {
        const bool isFirst = mPages++ == 0;
        if (mBytes) mOutput->set_ioproxy(&*mBytes);
        if (!mOutput->open(
                mPath, mSpec,
                isFirst ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage) ||
            !mOutput->write_image(mSpec.format, values)) {
            fail();
        }
    }

    void close() override {
        if (!mOutput->close()) fail();
        if (mBytes) writeBytes();
    }

  private:
    [[noreturn]] void fail() { throw Error(ErrorKind::Runtime, mOutput->geterror()); }

    void writeBytes() {
        const std::vector<unsigned char>& bytes = mBytes->buffer();
        std::ofstream stream(mPath, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
        stream.close();
        if (!stream) throw Error(ErrorKind::Runtime, std::strerror(errno));
    }

    std::string mPath;
    OIIO::ImageSpec mSpec;
    std::optional<OIIO::Filesystem::IOVecOutput> mBytes;  // of a .png file
    std::unique_ptr<OIIO::ImageOutput> mOutput;
    int mPages = 0;
};

}  // namespace

std::unique_ptr<SliceFile> openSliceFile(const std::filesystem::path& path, int threads) {
    return std::make_unique<OpenImageIoSlices>(path, threads);
}

std::unique_ptr<SliceOutput> createSliceFile(const std::filesystem::path& path,
                                             const SliceOutputInfo& info) {
    return std::make_unique<OpenImageIoOutput>(path, info);
}

}  // namespace bandvox
