#include "source/file_integrity.h"
#include "source/table_rows.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/read_scattered_points.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

std::string lowered(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

/// Takes rows one after another, of which some columns count.
class PointTaker {
  public:
    /// `names`: of the file's columns, empty if it has none.
    PointTaker(const FileContents& file, std::size_t width, std::vector<std::string> names,
               const PointColumnChoice& choice);

    const std::vector<std::size_t>& columns() const { return mColumns; }

    /// The names of what is taken.
    std::string nameOf(std::size_t i) const {
        if (i < mPlaces) return i == 0 ? "x" : i == 1 ? "y" : "z";
        if (!mNames.empty()) return mNames[mColumns[i]];
        if (mColumns.size() == mPlaces + 1) return "value";
        return "value " + std::to_string(i - mPlaces + 1);
    }

    /// `row`: the numbers of the chosen columns. `line`: where they stand. Calls `fail(what)`,
    /// which throws.
    template <typename Fail>
    void add(const std::vector<double>& row, std::size_t line, const Fail& fail) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (std::isfinite(row[i])) continue;
            std::string message = "has ";
            message += std::isnan(row[i]) ? "nan" : "inf";
            message += " as " + nameOf(i);
            message += "; expected a finite number";
            fail(message);
        }
        mPoints.x.push_back(row[0]);
        mPoints.y.push_back(row[1]);
        if (mPlaces == 3) mPoints.z.push_back(row[2]);
        mPoints.values.insert(mPoints.values.end(),
                              row.begin() + static_cast<std::ptrdiff_t>(mPlaces), row.end());
        mPoints.lines.push_back(static_cast<std::uint32_t>(line));
    }

    NamedPoints take(const std::string& lineWord) {
        NamedPoints result;
        mPoints.columns = static_cast<int>(mColumns.size() - mPlaces);
        mPoints.lineWord = lineWord;
        for (std::size_t i = mPlaces; i < mColumns.size(); ++i) result.names.push_back(nameOf(i));
        result.points = std::move(mPoints);
        return result;
    }

  private:
    std::size_t chosen(const std::string& name, std::size_t width) const;

    std::size_t mPlaces;  // columns of a place
    std::vector<std::string> mNames;
    std::vector<std::size_t> mColumns;
    ScatteredPoints mPoints;
};

std::size_t PointTaker::chosen(const std::string& name, std::size_t width) const {
    for (std::size_t i = 0; i < mNames.size(); ++i) {
        if (lowered(mNames[i]) == lowered(name)) return i;
    }
    std::size_t number = 0;
    const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (status == std::errc() && end == name.data() + name.size() && number >= 1 &&
        number <= width) {
        return number - 1;
    }
    std::string message = "there is no column '" + name + "'; expected a number from 1 to ";
    message += std::to_string(width);
    for (const std::string& known : mNames) message += ", '" + known + "'";
    throw Error(ErrorKind::Usage, message);
}

PointTaker::PointTaker(const FileContents& file, std::size_t width, std::vector<std::string> names,
                       const PointColumnChoice& choice)
    : mPlaces(choice.isInSpace ? 3 : 2), mNames(std::move(names)) {
    const std::size_t fewest = mPlaces + 1;
    const std::string expected = choice.isInSpace ? "x, y, z and a value" : "x, y and a value";
    if (width < fewest) {
        file.fail("has " + std::to_string(width) + " columns; expected " + std::to_string(fewest) +
                  " at least: " + expected);
    }
    if (!choice.columns.empty()) {
        for (const std::string& name : choice.columns) {
            const std::size_t column = chosen(name, width);
            if (std::find(mColumns.begin(), mColumns.end(), column) != mColumns.end()) {
                throw Error(ErrorKind::Usage,
                            "column '" + name + "' is chosen twice; expected different ones");
            }
            mColumns.push_back(column);
        }
        if (mColumns.size() < fewest) {
            throw Error(ErrorKind::Usage, std::to_string(mColumns.size()) +
                                              " columns are chosen; expected " + expected);
        }
        return;
    }
    const auto named = [&](const std::string& name) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < mNames.size(); ++i) {
            if (lowered(mNames[i]) == name) return i;
        }
        return std::nullopt;
    };
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < mPlaces; ++i) {
        if (const auto column = named(i == 0 ? "x" : i == 1 ? "y" : "z")) places.push_back(*column);
    }
    const bool areNamed = places.size() == mPlaces;
    for (std::size_t i = 0; i < mPlaces; ++i) mColumns.push_back(areNamed ? places[i] : i);
    const std::vector<std::size_t> taken = mColumns;
    for (std::size_t i = 0; i < width; ++i) {
        if (std::find(taken.begin(), taken.end(), i) == taken.end()) mColumns.push_back(i);
    }
}

NamedPoints readTable(const FileContents& file, const PointColumnChoice& choice,
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

/// What the header of a .npy file says, as far as it is of use here.
struct NpyTable {
    std::size_t begin = 0;  // of the numbers
    std::size_t rows = 0, columns = 0;
    bool isDouble = true;
};

/// The text after 'key': in the dictionary.
std::string_view npyEntry(const FileContents& file, std::string_view header,
                          const std::string& key) {
    const std::size_t at = header.find("'" + key + "':");
    if (at == std::string_view::npos) file.fail("has no '" + key + "' in its header");
    std::string_view entry = header.substr(at + key.size() + 3);
    entry.remove_prefix(std::min(entry.find_first_not_of(' '), entry.size()));
    return entry;
}

NpyTable readNpyTable(const FileContents& file) {
    const std::string_view bytes = file.bytes;
    const auto byte = [&](std::size_t i) {
        return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
    };
    if (!bytes.starts_with("\x93NUMPY") || bytes.size() < 12) {
        file.fail("is no .npy file: it does not begin as one");
    }
    const bool isShort = byte(6) == 1;
    const std::size_t length =
        byte(8) + (byte(9) << 8U) + (isShort ? 0 : (byte(10) << 16U) + (byte(11) << 24U));
    NpyTable table;
    table.begin = (isShort ? 10U : 12U) + length;
    if (table.begin > bytes.size()) file.fail("ends in its header");
    const std::string_view header = bytes.substr(0, table.begin);
    const std::string_view type = npyEntry(file, header, "descr");
    table.isDouble = type.starts_with("'<f8'");
    if (!table.isDouble && !type.starts_with("'<f4'")) {
        file.fail("has numbers of the type " + std::string(type.substr(0, 5)) +
                  "; expected '<f8' or '<f4', little-endian floats");
    }
    if (!npyEntry(file, header, "fortran_order").starts_with("False")) {
        file.fail("is in Fortran order; expected C order, a row for each point");
    }
    std::string_view shape = npyEntry(file, header, "shape");
    shape = shape.substr(0, shape.find(')'));
    const char* const end = shape.data() + shape.size();
    const auto rows = std::from_chars(shape.data() + 1, end, table.rows);
    const char* at = rows.ptr;
    while (at != end && (*at == ',' || *at == ' ')) ++at;
    const auto columns = std::from_chars(at, end, table.columns);
    if (rows.ec != std::errc() || columns.ec != std::errc() || columns.ptr != end) {
        file.fail("has the shape " + std::string(shape.substr(0, 40)) +
                  "); expected two sizes, points and columns");
    }
    const std::size_t has = bytes.size() - table.begin;
    const std::size_t each = table.isDouble ? 8 : 4;
    const bool fits = table.columns > 0 && table.rows <= has / each / table.columns;
    if (!fits || table.rows * table.columns * each != has) {
        file.fail("announces " + std::to_string(table.rows) + " rows of " +
                  std::to_string(table.columns) + " numbers and holds " + std::to_string(has) +
                  " bytes of them; expected as many as it announces");
    }
    return table;
}

NamedPoints readNpy(const FileContents& file, const PointColumnChoice& choice) {
    const NpyTable table = readNpyTable(file);
    PointTaker taker(file, table.columns, {}, choice);
    std::vector<double> row(taker.columns().size());
    const std::size_t each = table.isDouble ? 8 : 4;
    for (std::size_t i = 0; i < table.rows; ++i) {
        const char* const from = file.bytes.data() + table.begin + i * table.columns * each;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const char* const number = from + taker.columns()[k] * each;
            if (table.isDouble) {
                std::memcpy(&row[k], number, 8);
            } else {
                float single = 0;
                std::memcpy(&single, number, 4);
                row[k] = single;
            }
        }
        taker.add(row, i + 1, [&](const std::string& what) {
            file.fail("row " + std::to_string(i + 1) + " " + what);
        });
    }
    return taker.take("row");
}

}  // namespace

NamedPoints readScatteredPoints(const fs::path& path, const PointColumnChoice& choice,
                                Progress& progress) {
    const std::string extension = lowered(path.extension().string());
    const std::vector<std::string> known{".csv", ".xyz", ".txt", ".npy"};
    if (std::find(known.begin(), known.end(), extension) == known.end()) {
        throw Error(ErrorKind::Input, "\"" + path.string() +
                                          "\" is of an unknown kind; expected one of .csv .xyz "
                                          ".txt .npy");
    }
    std::error_code status;
    if (!fs::is_regular_file(path, status)) {
        throw Error(ErrorKind::Input, "\"" + path.string() +
                                          "\" is no file that can be read; expected a table of "
                                          "points");
    }
    const ProgressStage stage(progress, "read points", 0);
    const FileContents file = readFile(path);
    NamedPoints points =
        extension == ".npy" ? readNpy(file, choice) : readTable(file, choice, progress);
    if (points.points.size() == 0) file.fail("has no points; expected some");
    return points;
}

}  // namespace bandvox
