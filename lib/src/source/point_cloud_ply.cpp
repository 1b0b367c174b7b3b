#include "core/words.h"
#include "source/little_endian.h"
#include "source/ply_header.h"
#include "source/point_columns.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace bandvox {
namespace {

constexpr std::size_t kRowsPerCheck = std::size_t(1) << 18;

/// The value of a type at a byte.
double binaryValue(std::string_view bytes, std::size_t at, const PlyType& type, std::endian order) {
    const std::uint64_t bits = unsignedAt(bytes, at, type.bytes, order);
    if (type.isReal) {
        return type.bytes == 4 ? double(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                               : std::bit_cast<double>(bits);
    }
    const bool isNegative = type.isSigned && (bits >> (8 * type.bytes - 1)) != 0;
    return double(bits) - (isNegative ? double(std::uint64_t(1) << (8 * type.bytes)) : 0);
}

/// Bytes of an item, each of which is as long.
std::size_t strideOf(const FileContents& file, const PlyElement& element) {
    std::size_t stride = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.isList) {
            file.fail("has a list '" + property.name + "' in its element '" + element.name +
                      "'; expected points without lists, and none before them");
        }
        stride += property.type.bytes;
    }
    return stride;
}

/// What is read of the vertices.
class PlyPoints {
  public:
    PlyPoints(const FileContents& file, const PlyElement& vertex, Progress& progress)
        : mFile(file), mVertex(vertex), mCount(std::size_t(vertex.count)), mProgress(progress) {
        strideOf(file, vertex);
        std::vector<std::string> names;
        for (const PlyProperty& property : vertex.properties) names.push_back(property.name);
        mColumns = columnsByName(names, [&](const std::string& what) { file.fail(what); });
    }

    PointCloud readBinary(std::size_t begin, std::endian order) {
        const std::size_t stride = strideOf(mFile, mVertex);
        if (mCount > (mFile.bytes.size() - begin) / stride) {
            failShort((mFile.bytes.size() - begin) / stride);
        }
        std::vector<std::size_t> offsets;
        std::size_t offset = 0;
        for (const PlyProperty& property : mVertex.properties) {
            offsets.push_back(offset);
            offset += property.type.bytes;
        }
        return read([&](std::size_t row, std::size_t column) {
            return binaryValue(mFile.bytes, begin + row * stride + offsets[column],
                               mVertex.properties[column].type, order);
        });
    }

    PointCloud readText(TextLines& lines) {
        // Each number takes a character and one more behind it.
        const std::size_t width = mVertex.properties.size();
        if (mCount > (mFile.bytes.size() - lines.position() + 1) / (2 * width)) {
            failShort((mFile.bytes.size() - lines.position() + 1) / (2 * width));
        }
        std::size_t current = mCount;
        return read([&](std::size_t row, std::size_t column) {
            if (row != current) {
                if (!lines.nextWithWords()) failShort(row);
                if (lines.words().size() != width) {
                    lines.fail("has " + counted(lines.words().size(), "number", "numbers") +
                               "; expected " + std::to_string(width));
                }
                current = row;
            }
            return lines.coordinate(column);
        });
    }

  private:
    [[noreturn]] void failShort(std::size_t most) const {
        mFile.fail("is cut short: its header says " + counted(mCount, "point", "points") +
                   ", and there is room for " + std::to_string(most) + " at most");
    }

    template <typename Value>
    PointCloud read(const Value& value) {
        PointCloudBuilder builder(mColumns, mCount);
        std::array<double, kPointValues> values{};
        std::int64_t told = 0;
        for (std::size_t row = 0; row < mCount; ++row) {
            for (std::size_t i = 0; i < kPointValues; ++i) {
                if (mColumns.column[i]) values[i] = value(row, *mColumns.column[i]);
            }
            builder.add(values, [&](const std::string& what) {
                mFile.fail("point " + std::to_string(row + 1) + " " + what);
            });
            if (row % kRowsPerCheck != kRowsPerCheck - 1) continue;
            mProgress.throwIfInterrupted();
            const auto steps = static_cast<std::int64_t>(100 * row / mCount);
            mProgress.advance(steps - std::exchange(told, steps));
        }
        return builder.take();
    }

    const FileContents& mFile;
    const PlyElement& mVertex;
    std::size_t mCount;
    Progress& mProgress;
    PointColumns mColumns;
};

}  // namespace

PointCloud readPlyPoints(const FileContents& file, Progress& progress) {
    TextLines lines(file);
    const PlyHeader header = readPlyHeader(file, lines);
    const PlyElement* vertex = header.find("vertex");
    if (vertex == nullptr || vertex->count == 0) {
        file.fail("has no points; expected one at least");
    }
    if (header.hasFaces()) file.fail("has faces; expected points alone");
    PlyPoints points(file, *vertex, progress);

    // Pass over what stands before them.
    std::size_t begin = lines.position();
    for (const PlyElement* before = header.elements.data(); before != vertex; ++before) {
        if (header.encoding == PlyEncoding::Text) {
            for (std::int64_t i = 0; i < before->count; ++i) {
                if (!lines.nextWithWords()) file.fail("is cut short before its points");
            }
        } else {
            const std::size_t stride = strideOf(file, *before);
            if (stride == 0) continue;
            if (std::uint64_t(before->count) > (file.bytes.size() - begin) / stride) {
                file.fail("is cut short before its points");
            }
            begin += std::size_t(before->count) * stride;
        }
    }
    if (header.encoding == PlyEncoding::Text) return points.readText(lines);
    return points.readBinary(begin, header.encoding == PlyEncoding::LittleEndian
                                        ? std::endian::little
                                        : std::endian::big);
}

}  // namespace bandvox
