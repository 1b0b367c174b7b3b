#include "source/file_integrity.h"
#include "source/point_columns.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace bandvox {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

std::string_view withoutBlanks(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// The characters that begin a comment; 0 if the line is none.
std::size_t commentMark(std::string_view line) {
    const std::string_view text = withoutBlanks(line);
    return text.starts_with("//") ? 2 : text.starts_with('#') ? 1 : 0;
}

// A number too small for a double is as good as 0; one too large is infinite.
std::optional<double> numberOf(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [at, status] = std::from_chars(word.data(), end, value);
    if (at != end || status == std::errc::invalid_argument) return std::nullopt;
    if (status == std::errc::result_out_of_range) {
        const bool isSmall =
            word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
        return isSmall ? 0 : std::numeric_limits<double>::infinity();
    }
    return value;
}

char separatorOf(std::string_view line) {
    for (const char separator : {';', '\t', ','}) {
        if (line.find(separator) != std::string_view::npos) return separator;
    }
    return ' ';
}

/// The rows of a table, one after another.
class PointTable {
  public:
    explicit PointTable(const FileContents& file) : mFile(file), mRest(file.bytes) {
        if (mRest.starts_with("\xEF\xBB\xBF")) mRest.remove_prefix(3);
    }

    /// Finds the first row, of names or numbers; false if there is none.
    bool begin() {
        bool isFirst = true;
        for (std::string_view line; takeLine(line);) {
            if (withoutBlanks(line).empty()) continue;
            const std::size_t mark = commentMark(line);
            if (mark == 0) {
                mSeparator = separatorOf(withoutBlanks(line));
                split(line);
                return true;
            }
            if (!std::exchange(isFirst, false)) continue;
            const std::string_view text = withoutBlanks(withoutBlanks(line).substr(mark));
            mSeparator = separatorOf(text);
            split(text);
            if (namePoints(names())) return true;
        }
        return false;
    }

    /// Goes to the next row; false at the end.
    bool next() {
        for (std::string_view line; takeLine(line);) {
            if (commentMark(line) != 0 || withoutBlanks(line).empty()) continue;
            split(line);
            return true;
        }
        return false;
    }

    const std::vector<std::string_view>& cells() const { return mCells; }
    std::vector<std::string> names() const { return {mCells.begin(), mCells.end()}; }
    std::size_t position() const { return mFile.bytes.size() - mRest.size(); }

    [[noreturn]] void fail(const std::string& what) const {
        mFile.fail("line " + std::to_string(mNumber) + " " + what);
    }

  private:
    bool takeLine(std::string_view& line) {
        if (mRest.empty()) return false;
        const std::size_t end = mRest.find('\n');
        line = mRest.substr(0, end);
        mRest.remove_prefix(std::min(line.size() + 1, mRest.size()));
        ++mNumber;
        return true;
    }

    void split(std::string_view line) {
        mCells.clear();
        line = mSeparator == '\t' ? line.substr(0, line.find_last_not_of('\r') + 1)
                                  : withoutBlanks(line);
        if (mSeparator == ' ') {
            while (!line.empty()) {
                const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
                mCells.push_back(line.substr(0, end));
                line.remove_prefix(end);
                line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
            }
            return;
        }
        while (true) {
            const std::size_t end = line.find(mSeparator);
            mCells.push_back(withoutQuotes(withoutBlanks(line.substr(0, end))));
            if (end == std::string_view::npos) return;
            line.remove_prefix(end + 1);
        }
    }

    static std::string_view withoutQuotes(std::string_view cell) {
        const bool isQuoted = cell.size() > 1 && cell.starts_with('"') && cell.ends_with('"');
        return isQuoted ? cell.substr(1, cell.size() - 2) : cell;
    }

    const FileContents& mFile;
    std::string_view mRest;
    std::size_t mNumber = 0;
    char mSeparator = ' ';
    std::vector<std::string_view> mCells;
};

/// Of a first row without names.
PointColumns columnsByCount(const PointTable& table) {
    PointColumns columns;
    columns.isNamed = false;
    const std::size_t count = table.cells().size();
    if (count != 3 && count != 4 && count != 6) {
        table.fail("has " + std::to_string(count) + (count == 1 ? " number" : " numbers") +
                   "; expected 3 (x y z), 4 (and the radius) or 6 (and the normal), or names of "
                   "the columns");
    }
    for (std::size_t i = 0; i < (count == 6 ? 6 : 3); ++i) columns.column[i] = i;
    if (count == 4) columns.column[kRadiusValue] = 3;
    return columns;
}

double cellOf(const PointTable& table, std::size_t column, std::size_t value) {
    constexpr std::size_t kLongest = 40;
    const std::string_view cell = table.cells()[column];
    const auto number = numberOf(cell);
    if (number) return *number;
    std::string message = "has ";
    if (cell.empty()) {
        message += "nothing";
    } else {
        message += "\"";
        message += cell.substr(0, kLongest);
        message += cell.size() > kLongest ? "...\"" : "\"";
    }
    message += " in column ";
    message += std::to_string(column + 1);
    message += ", ";
    message += kPointValueNames[value];
    table.fail(message + "; expected a number");
}

}  // namespace

PointCloud readTextPoints(const FileContents& file, Progress& progress) {
    PointTable table(file);
    if (!table.begin()) file.fail("has no points; expected one at least");
    const auto isNumber = [](std::string_view cell) { return numberOf(cell).has_value(); };
    const auto fail = [&](const std::string& what) { table.fail(what); };
    const bool isNamed = !std::all_of(table.cells().begin(), table.cells().end(), isNumber);
    const PointColumns columns =
        isNamed ? columnsByName(table.names(), fail) : columnsByCount(table);
    const std::size_t width = table.cells().size();

    PointCloudBuilder builder(columns, 0);
    std::array<double, kPointValues> values{};
    constexpr std::size_t kStep = std::size_t(1) << 22;
    std::size_t told = 0;
    for (bool isThere = !isNamed || table.next(); isThere; isThere = table.next()) {
        if (table.cells().size() != width) {
            table.fail("has " + std::to_string(table.cells().size()) + " columns; expected " +
                       std::to_string(width) + ", as in the first line");
        }
        for (std::size_t i = 0; i < kPointValues; ++i) {
            if (columns.column[i]) values[i] = cellOf(table, *columns.column[i], i);
        }
        builder.add(values, fail);
        if (table.position() - told < kStep) continue;
        progress.throwIfInterrupted();
        const auto steps = [&](std::size_t at) { return 100 * at / file.bytes.size(); };
        progress.advance(static_cast<std::int64_t>(steps(table.position()) - steps(told)));
        told = table.position();
    }
    return builder.take();
}

}  // namespace bandvox
