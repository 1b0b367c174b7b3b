#include "render/exr_file.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <exception>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bandvox {

namespace {

// Rows that are encoded at a time, whole blocks of the compression for every thread.
constexpr int kStripRows = 128;

constexpr float kLargestHalf = 65504;

// Takes what the encoder writes to a stream, and keeps what the disk has said about it.
class ExrStream final : public Imf::OStream {
  public:
    explicit ExrStream(std::ostream& stream) : OStream("picture.exr"), mStream(stream) {}

    void write(const char* bytes, int count) override {
        require(static_cast<bool>(mStream.write(bytes, count)));
    }
    std::uint64_t tellp() override { return static_cast<std::uint64_t>(mStream.tellp()); }
    void seekp(std::uint64_t place) override {
        require(static_cast<bool>(mStream.seekp(static_cast<std::streamoff>(place))));
    }

    // What went wrong first; 0 if nothing did.
    int failure() const { return mFailure; }

  private:
    void require(bool good) {
        if (good) return;
        if (mFailure == 0) mFailure = errno;
        throw std::runtime_error("the stream takes no more");
    }

    std::ostream& mStream;
    int mFailure = 0;
};

Imath::M44f toImath(const openvdb::Mat4d& matrix) {
    Imath::M44f result;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            result[row][column] = static_cast<float>(matrix(row, column));
        }
    }
    return result;
}

void setAttribute(Imf::Header& header, const std::string& name, const ImageAttribute& value) {
    if (const auto* text = std::get_if<std::string>(&value)) {
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* whole = std::get_if<int>(&value)) {
        header.insert(name, Imf::IntAttribute(*whole));
    } else if (const auto* number = std::get_if<double>(&value)) {
        header.insert(name, Imf::FloatAttribute(static_cast<float>(*number)));
    } else {
        header.insert(name, Imf::M44fAttribute(toImath(std::get<openvdb::Mat4d>(value))));
    }
}

// A channel of floats that lies in a picture.
struct DataChannel {
    const char* name;
    const float* values;
    int stride;  // floats from pixel to pixel
};

std::vector<DataChannel> dataChannels(const Image& image, const ImageChannels& channels) {
    std::vector<DataChannel> data;
    if (channels.depth) data.push_back({"Z", image.depth.data(), 1});
    if (channels.normal) {
        const float* normal = image.normal.data();
        data.insert(data.end(),
                    {{"N.X", normal, 3}, {"N.Y", normal + 1, 3}, {"N.Z", normal + 2, 3}});
    }
    if (channels.position) {
        const float* position = image.position.data();
        data.insert(data.end(),
                    {{"P.X", position, 3}, {"P.Y", position + 1, 3}, {"P.Z", position + 2, 3}});
    }
    for (const ImagePlane& plane : image.planes) {
        data.push_back({plane.name.c_str(), plane.values.data(), 1});
    }
    return data;
}

constexpr std::array<const char*, 4> kColorChannels{"R", "G", "B", "A"};

Imf::Header makeHeader(const Image& image, const ImageChannels& channels) {
    const Imath::V2i corner(image.left, image.top);
    const Imath::V2i size(image.width - 1, image.height - 1);
    const bool isPart = image.fullWidth > 0 && image.fullHeight > 0;
    const Imath::Box2i display =
        isPart ? Imath::Box2i({0, 0}, {image.fullWidth - 1, image.fullHeight - 1})
               : Imath::Box2i(corner, corner + size);
    Imf::Header header(display, Imath::Box2i(corner, corner + size), 1, {0, 0}, 1,
                       Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    // Most of what can be saved is saved by the quickest way.
    header.zipCompressionLevel() = 1;
    if (channels.color) {
        for (const char* name : kColorChannels) {
            header.channels().insert(name, Imf::Channel(Imf::HALF));
        }
    }
    for (const DataChannel& channel : dataChannels(image, channels)) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    }
    for (const auto& [name, value] : image.metadata) setAttribute(header, name, value);
    return header;
}

// Sends a channel's slice for all rows; the address is that of the pixel (0, 0) of the display.
template <typename Value>
void insertSlice(Imf::FrameBuffer& buffer, const char* name, Imf::PixelType type,
                 const Value* values, const Image& image, int firstRow, int stride) {
    const std::ptrdiff_t pixel = stride * static_cast<std::ptrdiff_t>(sizeof(Value));
    const std::ptrdiff_t row = pixel * image.width;
    const auto* base = reinterpret_cast<const char*>(values) - image.left * pixel - firstRow * row;
    buffer.insert(name, Imf::Slice(type, const_cast<char*>(base), static_cast<std::size_t>(pixel),
                                   static_cast<std::size_t>(row)));
}

void writePixels(Imf::OutputFile& file, const Image& image, const ImageChannels& channels,
                 Progress& progress) {
    Imf::FrameBuffer buffer;
    for (const DataChannel& channel : dataChannels(image, channels)) {
        insertSlice(buffer, channel.name, Imf::FLOAT, channel.values, image, image.top,
                    channel.stride);
    }
    std::vector<Imath::half> colors;
    for (int top = 0; top < image.height; top += kStripRows) {
        progress.throwIfInterrupted();
        const int rows = std::min(kStripRows, image.height - top);
        const std::size_t rowLength = 4 * static_cast<std::size_t>(image.width);
        const float* from = &image.color[top * rowLength];
        colors.resize(rows * rowLength);
        std::transform(from, from + rows * rowLength, colors.begin(), [](float value) {
            return Imath::half(std::clamp(value, -kLargestHalf, kLargestHalf));
        });
        for (int c = 0; channels.color && c < 4; ++c) {
            insertSlice(buffer, kColorChannels[c], Imf::HALF, colors.data() + c, image,
                        image.top + top, 4);
        }
        file.setFrameBuffer(buffer);
        file.writePixels(rows);
    }
}

}  // namespace

WriteFailure writeExr(std::ostream& stream, const Image& image, const ImageChannels& channels,
                      Progress& progress) {
    ExrStream output(stream);
    try {
        Imf::setGlobalThreadCount(threadCount());
        Imf::OutputFile file(output, makeHeader(image, channels), threadCount());
        writePixels(file, image, channels, progress);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return {error.what(), output.failure()};
    }
    return {{}, output.failure()};
}

}  // namespace bandvox
