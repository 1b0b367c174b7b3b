#include "source/little_endian.h"
#include "source/text_lines.h"

#include <algorithm>
#include <array>
#include <optional>

namespace bandvox {
namespace {

struct Type {
    std::size_t bytes = 0;
    bool isSigned = false;
    bool isReal = false;
};

struct Property {
    std::string name;
    Type type;
    bool isList = false;
    Type countType;
};

struct Element {
    std::string name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding { Text, LittleEndian, BigEndian };

struct Header {
    Encoding encoding = Encoding::Text;
    std::vector<Element> elements;
};

Type readType(std::string_view word, const TextLines& lines) {
    struct Named {
        std::string_view name, otherName;
        Type type;
    };
    static constexpr std::array<Named, 8> kTypes = {{{"char", "int8", {1, true, false}},
                                                     {"uchar", "uint8", {1, false, false}},
                                                     {"short", "int16", {2, true, false}},
                                                     {"ushort", "uint16", {2, false, false}},
                                                     {"int", "int32", {4, true, false}},
                                                     {"uint", "uint32", {4, false, false}},
                                                     {"float", "float32", {4, true, true}},
                                                     {"double", "float64", {8, true, true}}}};
    for (const Named& named : kTypes) {
        if (word == named.name || word == named.otherName) return named.type;
    }
    lines.fail("has the type \"" + std::string(word.substr(0, 40)) +
               "\"; expected one of PLY's, such as float or int");
}

Property readProperty(const TextLines& lines) {
    const auto& words = lines.words();
    const bool isList = words.size() > 1 && words[1] == "list";
    if (words.size() < (isList ? 5u : 3u)) {
        lines.fail("has an incomplete property; expected its type and name");
    }
    Property property;
    property.isList = isList;
    property.name = words[isList ? 4 : 2];
    property.type = readType(words[isList ? 3 : 1], lines);
    if (isList) {
        property.countType = readType(words[2], lines);
        if (property.countType.isReal) lines.fail("counts a list by a real; expected an integer");
    }
    return property;
}

/// Reads the header and leaves `lines` at its end.
Header readHeader(const FileContents& file, TextLines& lines) {
    if (!lines.next() || lines.words().size() != 1 || lines.words()[0] != "ply") {
        file.fail("does not begin with \"ply\"");
    }
    Header header;
    bool hasFormat = false;
    while (true) {
        if (!lines.nextWithWords()) file.fail("is cut short: its header has no \"end_header\"");
        const auto& words = lines.words();
        if (words[0] == "end_header") break;
        if (words[0] == "format") {
            const std::string_view name = words.size() > 1 ? words[1] : "";
            if (name == "binary_little_endian") {
                header.encoding = Encoding::LittleEndian;
            } else if (name == "binary_big_endian") {
                header.encoding = Encoding::BigEndian;
            } else if (name != "ascii") {
                lines.fail(
                    "has an unknown format; expected ascii, binary_little_endian or "
                    "binary_big_endian");
            }
            hasFormat = true;
        } else if (words[0] == "element") {
            if (words.size() < 3) lines.fail("has an incomplete element; expected name and count");
            header.elements.push_back({std::string(words[1]), lines.integer(2), {}});
            if (header.elements.back().count < 0) lines.fail("has a negative count");
        } else if (words[0] == "property") {
            if (header.elements.empty()) lines.fail("has a property before any element");
            header.elements.back().properties.push_back(readProperty(lines));
        }
    }
    if (!hasFormat) file.fail("has no format in its header");
    return header;
}

/// Reads the values after the header, whatever the encoding.
class Values {
  public:
    Values(const FileContents& file, TextLines& lines, Encoding encoding)
        : mFile(file), mLines(lines), mEncoding(encoding), mPosition(lines.position()) {}

    /// Goes to the next item of an element.
    bool nextItem() {
        if (mEncoding != Encoding::Text) return true;
        mWord = 0;
        return mLines.nextWithWords();
    }

    /// Reads a value of this type; nothing if the file or the line ends before. Reals are only
    /// checked.
    std::optional<std::int64_t> read(const Type& type) {
        return mEncoding == Encoding::Text ? readWord(type) : readBytes(type);
    }

  private:
    std::optional<std::int64_t> readWord(const Type& type) {
        if (mWord >= mLines.words().size()) return std::nullopt;
        const std::size_t word = mWord++;
        if (!type.isReal) return mLines.integer(word);
        mLines.coordinate(word);
        return 0;
    }

    std::optional<std::int64_t> readBytes(const Type& type) {
        if (mFile.bytes.size() - mPosition < type.bytes) return std::nullopt;
        const std::uint64_t bits = unsignedAt(
            mFile.bytes, mPosition, type.bytes,
            mEncoding == Encoding::LittleEndian ? std::endian::little : std::endian::big);
        mPosition += type.bytes;
        if (type.isReal) return 0;
        const bool negative = type.isSigned && (bits >> (8 * type.bytes - 1)) != 0;
        return static_cast<std::int64_t>(bits) -
               (negative ? std::int64_t(1) << (8 * type.bytes) : 0);
    }

    const FileContents& mFile;
    TextLines& mLines;
    Encoding mEncoding;
    std::size_t mPosition;
    std::size_t mWord = 0;
};

/// Checks the items of an element one by one.
class ElementCheck {
  public:
    ElementCheck(const FileContents& file, Values& values, PointUse& use, std::int64_t points)
        : mFile(file), mValues(values), mUse(use), mPoints(points) {}

    void check(const Element& element) {
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
    bool checkItem(const Element& element) {
        for (const Property& property : element.properties) {
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

const Element* findElement(const Header& header, std::string_view name) {
    const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                    [name](const Element& e) { return e.name == name; });
    return found == header.elements.end() ? nullptr : &*found;
}

}  // namespace

void checkPly(const FileContents& file, std::vector<std::string>& warnings) {
    TextLines lines(file);
    const Header header = readHeader(file, lines);
    const Element* vertex = findElement(header, "vertex");
    if (vertex == nullptr || vertex->count == 0) file.fail("has no points; expected a surface");
    if (vertex->properties.empty() ||
        static_cast<std::uint64_t>(vertex->count) > file.bytes.size()) {
        file.fail("is cut short: its header says " + std::to_string(vertex->count) + " points");
    }
    const Element* face = findElement(header, "face");
    const Element* strips = findElement(header, "tristrips");
    if ((face == nullptr || face->count == 0) && (strips == nullptr || strips->count == 0)) {
        file.fail("has no faces; expected a surface");
    }

    // Each value takes a byte at least, so every loop ends with the file.
    PointUse use;
    Values values(file, lines, header.encoding);
    ElementCheck check(file, values, use, vertex->count);
    for (const Element& element : header.elements) check.check(element);

    // Binary files need no newline at their end, and strips are not followed here.
    if (header.encoding != Encoding::Text || strips != nullptr) return;
    use.setCount(static_cast<std::size_t>(vertex->count));
    use.finish(file, warnings);
}

}  // namespace bandvox
