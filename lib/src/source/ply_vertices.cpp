#include "source/ply_vertices.h"

#include "core/words.h"
#include "source/little_endian.h"

#include <algorithm>
#include <bit>
#include <cstdint>
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

/// Tells of the rows that are read, and stops when that is asked for.
class RowProgress {
  public:
    RowProgress(Progress& progress, std::size_t count) : mProgress(progress), mCount(count) {}

    void done(std::size_t row) {
        if (row % kRowsPerCheck != kRowsPerCheck - 1) return;
        mProgress.throwIfInterrupted();
        const auto steps = static_cast<std::int64_t>(100 * row / mCount);
        mProgress.advance(steps - std::exchange(mTold, steps));
    }

  private:
    Progress& mProgress;
    std::size_t mCount;
    std::int64_t mTold = 0;
};

}  // namespace

PlyVertices::PlyVertices(const FileContents& file)
    : mFile(file), mLines(file), mHeader(readPlyHeader(file, mLines)), mBegin(mLines.position()) {
    const PlyElement* const vertex = mHeader.find("vertex");
    if (vertex == nullptr || vertex->count == 0) {
        file.fail("has no points; expected one at least");
    }
    mIndex = static_cast<std::size_t>(vertex - mHeader.elements.data());
    // So that nobody makes room for what cannot be there.
    const std::size_t stride = strideOf(file, *vertex);
    const bool isText = mHeader.encoding == PlyEncoding::Text;
    const std::size_t least = isText ? 2 * properties().size() : stride;
    const std::size_t room = (file.bytes.size() - mBegin + 1) / std::max<std::size_t>(least, 1);
    if (count() > room) failShort(room);
}

std::vector<std::string> PlyVertices::names() const {
    std::vector<std::string> names;
    for (const PlyProperty& property : properties()) names.push_back(property.name);
    return names;
}

void PlyVertices::failShort(std::size_t most) const {
    mFile.fail("is cut short: its header says " + counted(count(), "point", "points") +
               ", and there is room for " + std::to_string(most) + " at most");
}

/// Passes over what stands before the vertices.
void PlyVertices::passBefore() {
    for (std::size_t e = 0; e < mIndex; ++e) {
        const PlyElement& before = mHeader.elements[e];
        if (mHeader.encoding == PlyEncoding::Text) {
            for (std::int64_t i = 0; i < before.count; ++i) {
                if (!mLines.nextWithWords()) mFile.fail("is cut short before its points");
            }
            continue;
        }
        const std::size_t stride = strideOf(mFile, before);
        if (stride == 0) continue;
        if (std::uint64_t(before.count) > (mFile.bytes.size() - mBegin) / stride) {
            mFile.fail("is cut short before its points");
        }
        mBegin += std::size_t(before.count) * stride;
    }
}

void PlyVertices::readText(const std::vector<std::size_t>& columns, const Take& take) {
    // Each number takes a character and one more behind it.
    const std::size_t width = properties().size();
    const std::size_t room = (mFile.bytes.size() - mLines.position() + 1) / (2 * width);
    if (count() > room) failShort(room);
    std::vector<double> values(columns.size());
    for (std::size_t row = 0; row < count(); ++row) {
        if (!mLines.nextWithWords()) failShort(row);
        if (mLines.words().size() != width) {
            mLines.fail("has " + counted(mLines.words().size(), "number", "numbers") +
                        "; expected " + std::to_string(width));
        }
        for (std::size_t i = 0; i < columns.size(); ++i) values[i] = mLines.coordinate(columns[i]);
        take(row, values);
    }
}

void PlyVertices::readBinary(const std::vector<std::size_t>& columns, const Take& take) {
    const std::endian order =
        mHeader.encoding == PlyEncoding::LittleEndian ? std::endian::little : std::endian::big;
    const std::size_t stride = strideOf(mFile, vertex());
    const std::size_t room = (mFile.bytes.size() - mBegin) / stride;
    if (count() > room) failShort(room);
    std::vector<std::size_t> offsets;
    std::size_t offset = 0;
    for (const PlyProperty& property : properties()) {
        offsets.push_back(offset);
        offset += property.type.bytes;
    }
    std::vector<double> values(columns.size());
    for (std::size_t row = 0; row < count(); ++row) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            values[i] = binaryValue(mFile.bytes, mBegin + row * stride + offsets[columns[i]],
                                    properties()[columns[i]].type, order);
        }
        take(row, values);
    }
}

void PlyVertices::read(const std::vector<std::size_t>& columns, const Take& take,
                       Progress& progress) {
    passBefore();
    RowProgress rows(progress, count());
    const Take takeRow = [&](std::size_t row, const std::vector<double>& values) {
        take(row, values);
        rows.done(row);
    };
    if (mHeader.encoding == PlyEncoding::Text) return readText(columns, takeRow);
    readBinary(columns, takeRow);
}

}  // namespace bandvox
