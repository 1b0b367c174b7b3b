#include "source/array_header.h"

#include <bandvox/source/world_space.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <sstream>
#include <string>

// "MetaIO documentation", itk.org/Wiki/ITK/MetaIO/Documentation.
namespace bandvox {

namespace {

constexpr std::size_t kLongestMetaLine = 1 << 16;
constexpr int kMostMetaLines = 1000;

using MetaFields = std::map<std::string, std::string>;

std::string trimmedValue(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::optional<ArrayType> metaType(const std::string& name) {
    static const std::map<std::string, ArrayType> types{
        {"MET_CHAR", ArrayType::Int8},       {"MET_UCHAR", ArrayType::UInt8},
        {"MET_SHORT", ArrayType::Int16},     {"MET_USHORT", ArrayType::UInt16},
        {"MET_INT", ArrayType::Int32},       {"MET_UINT", ArrayType::UInt32},
        {"MET_LONG", ArrayType::Int32},      {"MET_ULONG", ArrayType::UInt32},
        {"MET_LONG_LONG", ArrayType::Int64}, {"MET_ULONG_LONG", ArrayType::UInt64},
        {"MET_FLOAT", ArrayType::Float},     {"MET_DOUBLE", ArrayType::Double}};
    const auto found = types.find(name);
    if (found == types.end()) return std::nullopt;
    return found->second;
}

// The line ElementDataFile is the last one; names may follow it, one to a line.
MetaFields readMetaFields(const std::filesystem::path& path, std::istream& stream) {
    MetaFields fields;
    std::string line;
    for (int lines = 0; lines < kMostMetaLines; ++lines) {
        line.clear();
        char c = 0;
        while (stream.get(c) && c != '\n' && line.size() < kLongestMetaLine) line += c;
        const std::size_t equals = line.find('=');
        if (!stream || equals == std::string::npos) break;
        const std::string name = trimmedValue(line.substr(0, equals));
        fields[name] = trimmedValue(line.substr(equals + 1));
        if (name == "ElementDataFile") return fields;
    }
    failArray(path, "it is no MetaImage file, or is cut short: there is no ElementDataFile");
}

std::string metaField(const MetaFields& fields, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        const auto found = fields.find(name);
        if (found != fields.end()) return found->second;
    }
    return "";
}

bool isOrientationCode(const std::string& text) {
    return text.size() == 3 && text.find_first_not_of("RLAPSI") == std::string::npos;
}

bool isTrue(const std::string& text) {
    return !text.empty() && (text[0] == 'T' || text[0] == 't' || text[0] == '1');
}

openvdb::Mat4d metaTransform(const std::filesystem::path& path, const MetaFields& fields,
                             bool& hasTransform) {
    const std::string spacing = metaField(fields, {"ElementSpacing", "ElementSize"});
    const std::string offset = metaField(fields, {"Offset", "Position", "Origin"});
    const std::string turn = metaField(fields, {"TransformMatrix", "Rotation", "Orientation"});
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    if (!turn.empty()) {
        const std::vector<double> numbers = numbersIn(path, turn, 9, "TransformMatrix");
        for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = numbers[i];
    }
    if (!spacing.empty()) {
        const std::vector<double> numbers = numbersIn(path, spacing, 3, "ElementSpacing");
        for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) *= numbers[i / 3];
    }
    if (!offset.empty()) {
        const std::vector<double> numbers = numbersIn(path, offset, 3, "Offset");
        for (int i = 0; i < 3; ++i) matrix(3, i) = numbers[i];
    }
    hasTransform = !spacing.empty() || !offset.empty() || !turn.empty();
    return matrix;
}

// Files of slices: LIST, with a name on each line that follows.
std::vector<std::filesystem::path> metaFiles(const std::filesystem::path& path,
                                             const std::string& file, std::istream& stream) {
    if (file == "LOCAL" || file == "Local" || file == "local") return {path};
    const std::filesystem::path folder = path.parent_path();
    if (file.find('%') != std::string::npos) {
        failArray(path,
                  "its values are in files named by a pattern, which is not read; expected "
                  "LOCAL, a file, or LIST");
    }
    if (!file.starts_with("LIST")) return {folder / file};
    std::vector<std::filesystem::path> files;
    std::string line;
    while (files.size() < (1U << 20) && std::getline(stream, line)) {
        if (const std::string name = trimmedValue(line); !name.empty()) {
            files.push_back(folder / name);
        }
    }
    if (files.empty()) failArray(path, "it lists no data files");
    return files;
}

}  // namespace

ArrayHeader readMetaImageHeader(const std::filesystem::path& path, std::istream& stream) {
    const MetaFields fields = readMetaFields(path, stream);
    const std::string dimensions = metaField(fields, {"NDims"});
    const std::string channels = metaField(fields, {"ElementNumberOfChannels"});
    if (dimensions != "3" || (!channels.empty() && channels != "1")) {
        failArray(path, "it has '" + dimensions.substr(0, 10) + "' dimensions and '" +
                            channels.substr(0, 10) +
                            "' channels; expected 3, and a number for each voxel");
    }
    ArrayHeader header;
    const std::string typeName = metaField(fields, {"ElementType"});
    const auto type = metaType(typeName);
    if (!type) {
        failArray(path, "its values are of type '" + typeName.substr(0, 40) +
                            "'; expected MET_UCHAR, MET_SHORT, MET_FLOAT or another number");
    }
    header.type = *type;
    header.info.size =
        arraySize(path, numbersIn(path, metaField(fields, {"DimSize"}), 3, "DimSize"));
    header.info.axes = {0, 1, 2};
    header.info.toWorld = metaTransform(path, fields, header.info.hasTransform);
    // What it says is where the array's axes come from; the world of scans is always the same.
    if (isOrientationCode(metaField(fields, {"AnatomicalOrientation"}))) {
        header.info.space = worldSpaceName("LPS");
    }
    header.bigEndian = isTrue(metaField(fields, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
    if (metaField(fields, {"BinaryData"}).starts_with("F")) {
        header.encoding = ArrayHeader::Encoding::Text;
    }
    if (isTrue(metaField(fields, {"CompressedData"}))) {
        header.encoding = ArrayHeader::Encoding::Zlib;
    }
    header.files = metaFiles(path, metaField(fields, {"ElementDataFile"}), stream);
    if (header.files.front() == path) {
        header.skipBytes = stream.tellg();
        return header;
    }
    if (const std::string size = metaField(fields, {"HeaderSize"}); !size.empty()) {
        header.skipBytes =
            static_cast<std::int64_t>(numbersIn(path, size, 1, "HeaderSize").front());
    }
    return header;
}

}  // namespace bandvox
