#include "core/image_library.h"
#include "render/exr_file.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/render/image.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
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

// The metadata as text, for formats that know of nothing else.
std::vector<std::pair<std::string, std::string>> textMetadata(const Image& image) {
    std::vector<std::pair<std::string, std::string>> entries;
    for (const auto& [name, value] : image.metadata) {
        std::ostringstream text;
        std::visit([&](const auto& v) { text << v; }, value);
        entries.emplace_back(name, text.str());
    }
    return entries;
}

WriteFailure writePng(std::ostream& stream, const Image& image, Progress& progress) {
    PngRows png{image.width, image.height, textMetadata(image), {}};
    png.rows = [&](int top, int bottom, std::vector<float>& pixels) {
        progress.throwIfInterrupted();
        const std::size_t rowLength = 4 * static_cast<std::size_t>(image.width);
        for (std::size_t p = 0; p < (bottom - top) * rowLength; p += 4) {
            const float* color = &image.color[top * rowLength + p];
            const float alpha = color[3];
            for (int c = 0; c < 3; ++c) {
                pixels[p + c] = alpha > 0 ? std::max(color[c] / alpha, 0.0F) : 0;
            }
            pixels[p + 3] = alpha;
        }
    };
    return imageLibrary().writePng(stream, png);
}

// How a picture is written.
struct Encoding {
    bool png;
    ImageChannels channels;
};

Encoding encodingFor(const std::filesystem::path& path, const ImageChannels& channels) {
    const std::string extension = extensionOf(path);
    if (extension == ".png") return {true, channels};
    if (extension != ".exr") failExtension(path);
    if (!channels.color && !channels.depth && !channels.normal && !channels.position) {
        throw Error(ErrorKind::Usage, "an .exr needs a channel at least, but got none");
    }
    return {false, channels};
}

WriteFailure encode(std::ostream& stream, const Image& image, const Encoding& encoding,
                    Progress& progress) {
    return encoding.png ? writePng(stream, image, progress)
                        : writeExr(stream, image, encoding.channels, progress);
}

}  // namespace

bool isImageFile(const std::filesystem::path& path) {
    const std::string extension = extensionOf(path);
    return extension == ".png" || extension == ".exr";
}

std::string colorConfigurationFault() {
    // Without one nothing needs to be loaded.
    const char* const name = std::getenv("OCIO");
    return name == nullptr || *name == '\0' ? "" : imageLibrary().colorFault();
}

void writeImage(AtomicFile& file, const Image& image, const ImageChannels& channels,
                Progress& progress) {
    const std::filesystem::path& path = file.target();
    const Encoding encoding = encodingFor(path, channels);
    requireComplete(image);
    std::ofstream stream = file.open();
    WriteFailure failure;
    if (file.inPlace()) {
        // An encoder goes back to fill in what it knows at the end.
        std::ostringstream memory;
        failure = encode(memory, image, encoding, progress);
        const std::string_view bytes = memory.view();
        errno = 0;
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.flush();
        if (!stream) failure.diskError = errno;
    } else {
        failure = encode(stream, image, encoding, progress);
    }
    if (failure.diskError == 0) {
        errno = 0;
        stream.close();
        if (!stream) failure.diskError = errno;
    }
    // What the disk says comes before what an encoder makes of it.
    if (failure.diskError != 0) fail(path, std::strerror(failure.diskError));
    if (!failure.text.empty() || !stream) {
        fail(path, failure.text.empty() ? "unknown failure" : failure.text);
    }
}

void writeImage(const std::filesystem::path& path, const Image& image,
                const ImageChannels& channels) {
    encodingFor(path, channels);
    requireComplete(image);
    AtomicFile file(path);
    writeImage(file, image, channels);
    file.commit();
}

}  // namespace bandvox
