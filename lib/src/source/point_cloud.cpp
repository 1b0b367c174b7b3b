#include "core/letter_case.h"
#include "core/words.h"
#include "source/file_integrity.h"
#include "source/ply_header.h"
#include "source/point_columns.h"

#include <bandvox/core/error.h>
#include <bandvox/source/point_cloud.h>

#include <algorithm>
#include <fstream>
#include <system_error>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

// Headers are short; what follows may be gigabytes.
constexpr std::size_t kLongestPlyHeader = 1 << 16;

/// Complains about what can be told from outside.
void checkPointFile(const fs::path& path) {
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::Input, "\"" + path.string() + "\" " + what);
    };
    std::error_code status;
    const fs::file_type type = fs::status(path, status).type();
    if (type == fs::file_type::not_found) fail("does not exist; expected a file of points");
    if (type == fs::file_type::directory) fail("is a folder; expected a file of points");
    if (type != fs::file_type::regular) fail("is not a regular file; expected a file of points");
    const std::string extension = lowerExtension(path);
    const auto& known = pointCloudExtensions();
    if (extension != ".ply" && std::find(known.begin(), known.end(), extension) == known.end()) {
        fail("is of an unknown kind; expected one of .ply .xyz .csv .txt");
    }
    if (fs::file_size(path, status) == 0 && !status) fail("is empty; expected points");
}

}  // namespace

const std::vector<std::string>& pointCloudExtensions() {
    static const std::vector<std::string> extensions{".xyz", ".csv", ".txt"};
    return extensions;
}

bool isPointCloudFile(const fs::path& path) {
    const std::string extension = lowerExtension(path);
    const auto& known = pointCloudExtensions();
    if (std::find(known.begin(), known.end(), extension) != known.end()) return true;
    std::error_code ignored;
    if (extension != ".ply" || !fs::is_regular_file(path, ignored)) return false;
    FileContents head{path, std::string(kLongestPlyHeader, '\0')};
    std::ifstream stream(path, std::ios::binary);
    stream.read(head.bytes.data(), static_cast<std::streamsize>(head.bytes.size()));
    head.bytes.resize(static_cast<std::size_t>(stream.gcount()));
    try {
        TextLines lines(head);
        const PlyHeader header = readPlyHeader(head, lines);
        return header.find("vertex") != nullptr && !header.hasFaces();
    } catch (const Error&) {
        // What is wrong with it is said when it is read.
        return false;
    }
}

PointCloud readPointCloud(const fs::path& path, Progress& progress) {
    checkPointFile(path);
    constexpr int kSteps = 100;
    const ProgressStage stage(progress, "read points", kSteps);
    const FileContents file = readFile(path);
    progress.throwIfInterrupted();
    PointCloud cloud = lowerExtension(path) == ".ply" ? readPlyPoints(file, progress)
                                                      : readTextPoints(file, progress);
    if (cloud.points.empty()) file.fail("has no points; expected one at least");
    return cloud;
}

std::optional<NamedValue> pointValueOfName(std::string_view name) {
    const std::string lower = inLowerCase(std::string(name));
    for (std::size_t i = 0; i < kPointValues; ++i) {
        if (lower == kPointValueNames[i]) return NamedValue{i, 1};
    }
    if (lower == "pscale" || lower == "scale") return NamedValue{kRadiusValue, 1};
    if (lower == "width" || lower == "diameter") return NamedValue{kRadiusValue, 0.5};
    return std::nullopt;
}

bool namePoints(const std::vector<std::string>& names) {
    std::array<bool, kNormalValue> found{};
    for (const std::string& name : names) {
        const auto value = pointValueOfName(name);
        if (value && value->value < kNormalValue) found[value->value] = true;
    }
    return found[0] && found[1] && found[2];
}

std::string PointCloudBuilder::shown(double value) {
    return inFull(value);
}

}  // namespace bandvox
