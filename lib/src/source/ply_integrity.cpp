#include "source/little_endian.h"
#include "source/ply_header.h"
#include "source/text_lines.h"

#include <optional>

namespace bandvox {
namespace {

/// Reads the values after the header, whatever the encoding.
class Values {
  public:
    Values(const FileContents& file, TextLines& lines, PlyEncoding encoding)
        : mFile(file), mLines(lines), mEncoding(encoding), mPosition(lines.position()) {}

    /// Goes to the next item of an element.
    bool nextItem() {
        if (mEncoding != PlyEncoding::Text) return true;
        mWord = 0;
        return mLines.nextWithWords();
    }

    /// Reads a value of this type; nothing if the file or the line ends before. Reals are only
    /// checked.
    std::optional<std::int64_t> read(const PlyType& type) {
        return mEncoding == PlyEncoding::Text ? readWord(type) : readBytes(type);
    }

  private:
    std::optional<std::int64_t> readWord(const PlyType& type) {
        if (mWord >= mLines.words().size()) return std::nullopt;
        const std::size_t word = mWord++;
        if (!type.isReal) return mLines.integer(word);
        mLines.coordinate(word);
        return 0;
    }

    std::optional<std::int64_t> readBytes(const PlyType& type) {
        if (mFile.bytes.size() - mPosition < type.bytes) return std::nullopt;
        const std::uint64_t bits = unsignedAt(
            mFile.bytes, mPosition, type.bytes,
            mEncoding == PlyEncoding::LittleEndian ? std::endian::little : std::endian::big);
        mPosition += type.bytes;
        if (type.isReal) return 0;
        const bool negative = type.isSigned && (bits >> (8 * type.bytes - 1)) != 0;
        return static_cast<std::int64_t>(bits) -
               (negative ? std::int64_t(1) << (8 * type.bytes) : 0);
    }

    const FileContents& mFile;
    TextLines& mLines;
    PlyEncoding mEncoding;
    std::size_t mPosition;
    std::size_t mWord = 0;
};

/// Checks the items of an element one by one.
class ElementCheck {
  public:
    ElementCheck(const FileContents& file, Values& values, PointUse& use, std::int64_t points)
        : mFile(file), mValues(values), mUse(use), mPoints(points) {}

    void check(const PlyElement& element) {
        if (element.properties.empty()) return;
        for (std::int64_t i = 0; i < element.count; ++i) {
            const bool complete = mValues.nextItem() && checkItem(element);
            if (complete) continue;
            mFile.fail("is cut short: item " + std::to_string(i + 1) + " of " +
                       std::to_string(element.count) + " of its element \"" + element.name +
                       "\" is missing or incomplete");
        }
    }

  private:
    /// False if the item is not all there.
    bool checkItem(const PlyElement& element) {
        for (const PlyProperty& property : element.properties) {
            std::int64_t count = 1;
            if (property.isList) {
                const auto read = mValues.read(property.countType);
                if (!read) return false;
                if (*read < 0) mFile.fail("has a list of negative length");
                count = *read;
            }
            const bool corners =
                property.isList && element.name == "face" &&
                (property.name == "vertex_indices" || property.name == "vertex_index");
            for (std::int64_t i = 0; i < count; ++i) {
                const auto value = mValues.read(property.type);
                if (!value) return false;
                if (corners) usePoint(*value);
            }
        }
        return true;
    }

    void usePoint(std::int64_t point) {
        if (point < 0 || point >= mPoints) {
            mFile.fail("has a face that refers to point " + std::to_string(point) +
                       "; expected 0 to " + std::to_string(mPoints - 1));
        }
        mUse.use(static_cast<std::size_t>(point));
    }

    const FileContents& mFile;
    Values& mValues;
    PointUse& mUse;
    std::int64_t mPoints;
};

}  // namespace

void checkPly(const FileContents& file, std::vector<std::string>& warnings) {
    TextLines lines(file);
    const PlyHeader header = readPlyHeader(file, lines);
    const PlyElement* vertex = header.find("vertex");
    if (vertex == nullptr || vertex->count == 0) file.fail("has no points; expected a surface");
    if (vertex->properties.empty() ||
        static_cast<std::uint64_t>(vertex->count) > file.bytes.size()) {
        file.fail("is cut short: its header says " + std::to_string(vertex->count) + " points");
    }
    if (!header.hasFaces()) file.fail("has no faces; expected a surface");

    // Each value takes a byte at least, so every loop ends with the file.
    PointUse use;
    Values values(file, lines, header.encoding);
    ElementCheck check(file, values, use, vertex->count);
    for (const PlyElement& element : header.elements) check.check(element);

    // Binary files need no newline at their end, and strips are not followed here.
    if (header.encoding != PlyEncoding::Text || header.find("tristrips") != nullptr) return;
    use.setCount(static_cast<std::size_t>(vertex->count));
    use.finish(file, warnings);
}

}  // namespace bandvox
