#include "source/array_header.h"

#include <bandvox/source/world_space.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>

// "Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html.
namespace bandvox {

namespace {

constexpr std::size_t kLongestLine = 1 << 16;
constexpr int kMostLines = 10000;

using Fields = std::map<std::string, std::string>;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::optional<std::string> nextLine(std::istream& stream) {
    std::string line;
    char c = 0;
    while (stream.get(c) && c != '\n') {
        if (line.size() == kLongestLine) return std::nullopt;
        line += c;
    }
    if (!stream && line.empty()) return std::nullopt;
    return trimmed(line);
}

std::optional<ArrayType> nrrdType(const std::string& name) {
    static const std::map<std::string, ArrayType> types{
        {"signed char", ArrayType::Int8},
        {"int8", ArrayType::Int8},
        {"int8_t", ArrayType::Int8},
        {"uchar", ArrayType::UInt8},
        {"unsigned char", ArrayType::UInt8},
        {"uint8", ArrayType::UInt8},
        {"uint8_t", ArrayType::UInt8},
        {"short", ArrayType::Int16},
        {"short int", ArrayType::Int16},
        {"signed short", ArrayType::Int16},
        {"signed short int", ArrayType::Int16},
        {"int16", ArrayType::Int16},
        {"int16_t", ArrayType::Int16},
        {"ushort", ArrayType::UInt16},
        {"unsigned short", ArrayType::UInt16},
        {"unsigned short int", ArrayType::UInt16},
        {"uint16", ArrayType::UInt16},
        {"uint16_t", ArrayType::UInt16},
        {"int", ArrayType::Int32},
        {"signed int", ArrayType::Int32},
        {"int32", ArrayType::Int32},
        {"int32_t", ArrayType::Int32},
        {"uint", ArrayType::UInt32},
        {"unsigned int", ArrayType::UInt32},
        {"uint32", ArrayType::UInt32},
        {"uint32_t", ArrayType::UInt32},
        {"longlong", ArrayType::Int64},
        {"long long", ArrayType::Int64},
        {"long long int", ArrayType::Int64},
        {"signed long long", ArrayType::Int64},
        {"signed long long int", ArrayType::Int64},
        {"int64", ArrayType::Int64},
        {"int64_t", ArrayType::Int64},
        {"ulonglong", ArrayType::UInt64},
        {"unsigned long long", ArrayType::UInt64},
        {"unsigned long long int", ArrayType::UInt64},
        {"uint64", ArrayType::UInt64},
        {"uint64_t", ArrayType::UInt64},
        {"float", ArrayType::Float},
        {"double", ArrayType::Double}};
    const auto found = types.find(name);
    if (found == types.end()) return std::nullopt;
    return found->second;
}

// Lines of data files may follow those of the header.
Fields readFields(const std::filesystem::path& path, std::istream& stream,
                  std::vector<std::string>& listed) {
    const auto magic = nextLine(stream);
    if (!magic || !magic->starts_with("NRRD000")) {
        failArray(path, "it is no NRRD file: it does not begin with NRRD000");
    }
    Fields fields;
    for (int lines = 0; lines < kMostLines; ++lines) {
        const auto line = nextLine(stream);
        if (!line || line->empty()) return fields;
        if ((*line)[0] == '#' || line->find(":=") != std::string::npos) continue;
        const std::size_t colon = line->find(':');
        if (colon == std::string::npos)
            failArray(path, "its header has the line '" + line->substr(0, 100) +
                                "'; expected FIELD: VALUE");
        const std::string name = lower(trimmed(line->substr(0, colon)));
        fields[name] = trimmed(line->substr(colon + 1));
        if ((name == "data file" || name == "datafile") && fields[name].starts_with("LIST")) {
            while (const auto file = nextLine(stream)) {
                if (!file->empty()) listed.push_back(*file);
            }
            return fields;
        }
    }
    failArray(path, "its header has too many lines");
}

std::string fieldOf(const Fields& fields, const std::string& name, const std::string& other = "") {
    auto found = fields.find(name);
    if (found == fields.end()) found = fields.find(other);
    return found == fields.end() ? "" : found->second;
}

// Files named by a pattern of printf, as slice%03d.raw 1 90 1.
std::vector<std::string> patternFiles(const std::filesystem::path& path, const std::string& text) {
    std::istringstream words(text);
    std::string pattern;
    int low = 0, high = 0, step = 0;
    words >> pattern >> low >> high >> step;
    const std::size_t percent = pattern.find('%');
    const std::size_t d = percent == std::string::npos ? percent : pattern.find('d', percent);
    const std::int64_t steps = step == 0 ? -1 : (std::int64_t(high) - low) / step;
    const bool isPattern = words && d != std::string::npos && step != 0 &&
                           pattern.find_first_not_of("0123456789", percent + 1) == d &&
                           d - percent <= 3 && pattern.find('%', d) == std::string::npos &&
                           steps >= 0 && steps < (1 << 20);
    if (!isPattern)
        failArray(path, "its data files are '" + text.substr(0, 100) +
                            "'; expected a "
                            "name, LIST, or a pattern as slice%03d.raw 1 90 1");
    const std::string digits = pattern.substr(percent + 1, d - percent - 1);
    const int width = digits.empty() ? 0 : std::stoi(digits);
    std::vector<std::string> files;
    for (std::int64_t i = 0; i <= steps; ++i) {
        std::string number = std::to_string(low + i * step);
        const bool zeros = !digits.empty() && digits[0] == '0';
        while (static_cast<int>(number.size()) < width) number.insert(0, 1, zeros ? '0' : ' ');
        files.push_back(pattern.substr(0, percent) + number + pattern.substr(d + 1));
    }
    return files;
}

// Numbers of which each may be "nan", which is not known.
std::vector<double> numbersOfAxes(const std::filesystem::path& path, const Fields& fields,
                                  const std::string& name, const std::string& other = "") {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const std::string text = fieldOf(fields, name, other);
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const bool isUnknown = lower(word) == "nan" || lower(word) == "-nan";
        numbers.push_back(isUnknown ? kUnknown : numbersIn(path, word, 1, name).front());
    }
    if (text.empty()) return std::vector<double>(3, kUnknown);
    if (numbers.size() == 3) return numbers;
    failArray(path, "its " + name + " are '" + text.substr(0, 100) + "'; expected 3 numbers");
}

// Spacings, and the ends of axes. Ends are those of cells unless it says that they are nodes.
openvdb::Mat4d transformOfAxes(const std::filesystem::path& path, const Fields& fields,
                               const openvdb::Coord& size, bool& hasTransform) {
    const auto spacings = numbersOfAxes(path, fields, "spacings");
    const auto mins = numbersOfAxes(path, fields, "axis mins", "axismins");
    const auto maxs = numbersOfAxes(path, fields, "axis maxs", "axismaxs");
    std::istringstream words(lower(fieldOf(fields, "centerings", "centers")));
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    hasTransform = false;
    for (int axis = 0; axis < 3; ++axis) {
        std::string centering;
        words >> centering;
        const bool isOfNodes = centering == "node";
        const int steps = isOfNodes ? size[axis] - 1 : size[axis];
        double step = spacings[axis];
        if (std::isnan(step) && steps > 0) step = (maxs[axis] - mins[axis]) / steps;
        const bool hasStep = !std::isnan(step);
        if (hasStep) matrix(axis, axis) = step;
        if (!std::isnan(mins[axis])) {
            matrix(3, axis) = mins[axis] + (isOfNodes || !hasStep ? 0 : step / 2);
        }
        hasTransform = hasTransform || hasStep || !std::isnan(mins[axis]);
    }
    return matrix;
}

openvdb::Mat4d nrrdTransform(const std::filesystem::path& path, const Fields& fields,
                             const openvdb::Coord& size, bool& hasTransform) {
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    const std::string directions = fieldOf(fields, "space directions");
    const std::string origin = fieldOf(fields, "space origin");
    if (!directions.empty()) {
        const std::vector<double> steps = numbersIn(path, directions, 9, "space directions");
        for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = steps[i];
        hasTransform = true;
    } else {
        matrix = transformOfAxes(path, fields, size, hasTransform);
    }
    if (!origin.empty()) {
        const std::vector<double> place = numbersIn(path, origin, 3, "space origin");
        for (int i = 0; i < 3; ++i) matrix(3, i) = place[i];
        hasTransform = true;
    }
    return matrix;
}

// The unit of lengths, if it is one for all axes, as "mm" "mm" "mm".
std::string nrrdUnit(const std::string& text) {
    std::vector<std::string> units;
    std::size_t open = 0;
    while ((open = text.find('"', open)) != std::string::npos) {
        const std::size_t close = text.find('"', open + 1);
        if (close == std::string::npos) break;
        units.push_back(trimmed(text.substr(open + 1, close - open - 1)));
        open = close + 1;
    }
    const bool isOne = units.size() == 3 && units[0] == units[1] && units[0] == units[2];
    return isOne ? units[0] : "";
}

ArrayHeader::Encoding nrrdEncoding(const std::filesystem::path& path, const std::string& name) {
    if (name == "raw") return ArrayHeader::Encoding::Raw;
    if (name == "gzip" || name == "gz") return ArrayHeader::Encoding::Zlib;
    if (name == "txt" || name == "text" || name == "ascii") return ArrayHeader::Encoding::Text;
    failArray(path, "its encoding is '" + name.substr(0, 40) + "'; expected raw, gzip or text");
}

}  // namespace

ArrayHeader readNrrdHeader(const std::filesystem::path& path, std::istream& stream) {
    std::vector<std::string> listed;
    const Fields fields = readFields(path, stream, listed);
    const std::string dimension = fieldOf(fields, "dimension");
    if (dimension != "3") {
        failArray(path, "it has " + (dimension.empty() ? "no" : dimension.substr(0, 10)) +
                            " dimensions; expected 3, and a number for each voxel");
    }
    ArrayHeader header;
    const std::string typeName = lower(fieldOf(fields, "type"));
    const auto type = nrrdType(typeName);
    if (!type) {
        failArray(path, "its values are of type '" + typeName.substr(0, 40) +
                            "'; expected whole numbers, float or double");
    }
    header.type = *type;
    header.encoding = nrrdEncoding(path, lower(fieldOf(fields, "encoding")));
    header.bigEndian = lower(fieldOf(fields, "endian")) == "big";
    header.info.size = arraySize(path, numbersIn(path, fieldOf(fields, "sizes"), 3, "sizes"));
    header.info.axes = {0, 1, 2};
    header.info.toWorld = nrrdTransform(path, fields, header.info.size, header.info.hasTransform);
    header.info.space = worldSpaceName(fieldOf(fields, "space"));
    header.info.unit = nrrdUnit(fieldOf(fields, "space units", "units"));
    const auto skip = [&](const char* name, const char* other) {
        const std::string text = fieldOf(fields, name, other);
        return text.empty() ? std::int64_t(0)
                            : static_cast<std::int64_t>(numbersIn(path, text, 1, name).front());
    };
    header.skipLines = skip("line skip", "lineskip");
    header.skipBytes = skip("byte skip", "byteskip");

    const std::string file = fieldOf(fields, "data file", "datafile");
    if (file.empty()) {
        header.files = {path};
        if (header.skipBytes >= 0) header.skipBytes += stream.tellg();
        return header;
    }
    std::vector<std::string> names{file};
    if (file.starts_with("LIST")) {
        names = listed;
    } else if (file.find('%') != std::string::npos) {
        names = patternFiles(path, file);
    }
    for (const std::string& name : names) header.files.push_back(path.parent_path() / name);
    if (header.files.empty()) failArray(path, "it lists no data files");
    return header;
}

}  // namespace bandvox
