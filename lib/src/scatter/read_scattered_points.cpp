#include "core/letter_case.h"
#include "scatter/point_taker.h"
#include "source/array_header.h"
#include "source/ply_vertices.h"
#include "source/srgb.h"
#include "source/table_rows.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <system_error>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

ScatteredPoints readTable(const FileContents& file, const PointColumnChoice& choice,
                          Progress& progress) {
    TableRows table(file);
    if (!table.begin([](const auto&) { return false; })) {
        file.fail("has no points; expected some");
    }
    // A row with a number in it is one of numbers, if with a slip.
    const bool isNamed = table.isOfWords();
    const std::size_t width = table.cells().size();
    PointTaker taker(file, width, isNamed ? table.names() : std::vector<std::string>(), choice);
    std::vector<double> row(taker.columns().size());
    std::size_t rows = 0;
    const auto fail = [&](const std::string& what) { table.fail(what); };
    for (bool isThere = !isNamed || table.next(); isThere; isThere = table.next()) {
        table.requireWidth(width);
        for (std::size_t i = 0; i < row.size(); ++i) {
            row[i] = table.number(taker.columns()[i], taker.nameOf(i));
        }
        taker.add(row, table.lineNumber(), fail);
        constexpr std::size_t kRowsBetween = 65536;
        if (++rows % kRowsBetween == 0) progress.throwIfInterrupted();
    }
    return taker.take("line");
}

ScatteredPoints readNpy(const FileContents& file, const PointColumnChoice& choice,
                        Progress& progress) {
    constexpr std::size_t kLongestHeader = 1 << 17;
    std::istringstream begin(file.bytes.substr(0, kLongestHeader));
    const NpyLayout layout = readNpyLayout(file.path, begin, 2);
    const auto start = static_cast<std::size_t>(begin.tellg());
    const double announced = layout.sizes[0] * layout.sizes[1];
    const std::size_t each = bytesOf(layout.type);
    const std::size_t has = file.bytes.size() - start;
    const auto rows = static_cast<std::size_t>(std::clamp(layout.sizes[0], 0.0, 1e15));
    const auto width = static_cast<std::size_t>(std::clamp(layout.sizes[1], 0.0, 1e15));
    if (!(announced * static_cast<double>(each) == static_cast<double>(has))) {
        file.fail("announces " + std::to_string(rows) + " rows of " + std::to_string(width) +
                  " numbers and holds " + std::to_string(has) +
                  " bytes of them; expected as many as it announces");
    }
    PointTaker taker(file, width, {}, choice);
    std::vector<double> row(taker.columns().size());
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < row.size(); ++k) {
            const std::size_t column = taker.columns()[k];
            const std::size_t at = layout.isFortran ? column * rows + i : i * width + column;
            toDoubles(file.bytes.data() + start + at * each, {&row[k], 1}, layout.type,
                      layout.bigEndian);
        }
        taker.add(row, i + 1, [&](const std::string& what) {
            file.fail("row " + std::to_string(i + 1) + " " + what);
        });
        constexpr std::size_t kRowsBetween = 1 << 20;
        if (i % kRowsBetween == kRowsBetween - 1) progress.throwIfInterrupted();
    }
    return taker.take("row");
}

/// Colours of a byte each are sRGB, as everywhere in .ply files.
bool isCodedColor(const PlyProperty& property) {
    static const std::array<std::string, 6> names{"red", "green", "blue", "r", "g", "b"};
    return property.type.bytes == 1 &&
           std::find(names.begin(), names.end(), property.name) != names.end();
}

ScatteredPoints readPly(const FileContents& file, const PointColumnChoice& choice,
                        Progress& progress) {
    PlyVertices vertices(file);
    PointTaker taker(file, vertices.properties().size(), vertices.names(), choice);
    const std::vector<std::size_t> columns = taker.columns();
    std::vector<double> point;
    const auto take = [&](std::size_t row, const std::vector<double>& values) {
        point = values;
        for (std::size_t i = 0; i < point.size(); ++i) {
            constexpr double kBrightest = 255;
            if (!isCodedColor(vertices.properties()[columns[i]])) continue;
            point[i] = linearOfSrgb(point[i] / kBrightest);
        }
        taker.add(point, row + 1, [&](const std::string& what) {
            file.fail("point " + std::to_string(row + 1) + " " + what);
        });
    };
    vertices.read(columns, take, progress);
    return taker.take("point");
}

}  // namespace

ScatteredPoints readScatteredPoints(const fs::path& path, const PointColumnChoice& choice,
                                    Progress& progress) {
    const std::string extension = lowerExtension(path);
    static const std::array<std::string, 5> known{".csv", ".xyz", ".txt", ".npy", ".ply"};
    if (std::find(known.begin(), known.end(), extension) == known.end()) {
        throw Error(ErrorKind::Input, "\"" + path.string() +
                                          "\" is of an unknown kind; expected one of .csv .xyz "
                                          ".txt .npy .ply");
    }
    std::error_code status;
    if (!fs::is_regular_file(path, status)) {
        throw Error(ErrorKind::Input, "\"" + path.string() +
                                          "\" is no file that can be read; expected a table of "
                                          "points");
    }
    const ProgressStage stage(progress, "read points", 0);
    const FileContents file = readFile(path);
    ScatteredPoints points = extension == ".npy"   ? readNpy(file, choice, progress)
                             : extension == ".ply" ? readPly(file, choice, progress)
                                                   : readTable(file, choice, progress);
    if (points.size() == 0) file.fail("has no points; expected some");
    return points;
}

}  // namespace bandvox
