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
#include <string>

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

// sRGB with alpha beside it, four bytes a pixel.
std::vector<std::uint8_t> srgbPixels(const Image& image) {
    std::vector<std::uint8_t> pixels(image.color.size());
    for (std::size_t p = 0; p < pixels.size(); p += 4) {
        const double alpha = image.color[p + 3];
        for (int c = 0; c < 3; ++c) {
            const double linear = alpha > 0 ? image.color[p + c] / alpha : 0;
            pixels[p + c] = eightBits(srgbOfLinear(std::max(linear, 0.0)));
        }
        pixels[p + 3] = eightBits(alpha);
    }
    return pixels;
}

// All channels of all pixels side by side, in the order of exrSpec.
std::vector<float> dataPixels(const Image& image) {
    const std::size_t pixels = pixelCount(image);
    std::vector<float> data;
    data.reserve(pixels * 11);
    for (std::size_t p = 0; p < pixels; ++p) {
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

// Encodes into memory, so that what the disk says is heard by this file and not by an encoder.
std::vector<unsigned char> encode(const std::filesystem::path& path, OIIO::ImageSpec spec,
                                  OIIO::TypeDesc format, const void* pixels) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create(path.string(), &memory);
    if (!output) fail(path, OIIO::geterror());
    if (!output->supports("ioproxy")) fail(path, "OpenImageIO cannot encode it in memory");
    OIIO::Filesystem::IOProxy* proxy = &memory;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!output->open(path.string(), spec) || !output->write_image(format, pixels) ||
        !output->close()) {
        fail(path, output->geterror());
    }
    return bytes;
}

void writeBytes(const std::filesystem::path& path, const std::vector<unsigned char>& bytes) {
    AtomicFile file(path);
    std::ofstream stream(file.temporary(), std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) fail(path, std::strerror(errno));
    file.commit();
}

}  // namespace

bool isImageFile(const std::filesystem::path& path) {
    const std::string extension = extensionOf(path);
    return extension == ".png" || extension == ".exr";
}

void writeImage(const std::filesystem::path& path, const Image& image) {
    if (!isImageFile(path)) {
        throw Error(ErrorKind::Usage, "cannot write " + path.string() + ": the extension is \"" +
                                          path.extension().string() + "\"; expected .png or .exr");
    }
    requireComplete(image);
    const bool png = extensionOf(path) == ".png";
    OIIO::ImageSpec spec = png ? pngSpec(image) : exrSpec(image);
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    const std::vector<unsigned char> bytes =
        png ? encode(path, spec, OIIO::TypeDesc::UINT8, srgbPixels(image).data())
            : encode(path, spec, OIIO::TypeDesc::FLOAT, dataPixels(image).data());
    writeBytes(path, bytes);
}

}  // namespace bandvox
