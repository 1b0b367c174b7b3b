#include "source/table_rows.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

namespace bandvox {
namespace {

constexpr std::string_view kCellBlanks = " \t\r\f\v";

std::string_view withoutBlanks(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kCellBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kCellBlanks) - begin + 1);
}

/// The characters that begin a comment; 0 if the line is none.
std::size_t commentMark(std::string_view line) {
    const std::string_view text = withoutBlanks(line);
    return text.starts_with("//") ? 2 : text.starts_with('#') ? 1 : 0;
}

char separatorOf(std::string_view line) {
    for (const char separator : {';', '\t', ','}) {
        if (line.find(separator) != std::string_view::npos) return separator;
    }
    return ' ';
}

std::string_view withoutQuotes(std::string_view cell) {
    const bool isQuoted = cell.size() > 1 && cell.starts_with('"') && cell.ends_with('"');
    return isQuoted ? cell.substr(1, cell.size() - 2) : cell;
}

}  // namespace

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

bool TableRows::begin(const std::function<bool(const std::vector<std::string>&)>& isHeader) {
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
        if (isHeader(names())) return true;
    }
    return false;
}

bool TableRows::next() {
    for (std::string_view line; takeLine(line);) {
        if (commentMark(line) != 0 || withoutBlanks(line).empty()) continue;
        split(line);
        return true;
    }
    return false;
}

bool TableRows::takeLine(std::string_view& line) {
    if (mRest.empty()) return false;
    const std::size_t end = mRest.find('\n');
    line = mRest.substr(0, end);
    mRest.remove_prefix(std::min(line.size() + 1, mRest.size()));
    ++mNumber;
    return true;
}

void TableRows::split(std::string_view line) {
    mCells.clear();
    line =
        mSeparator == '\t' ? line.substr(0, line.find_last_not_of('\r') + 1) : withoutBlanks(line);
    if (mSeparator == ' ') {
        while (!line.empty()) {
            const std::size_t end = std::min(line.find_first_of(kCellBlanks), line.size());
            mCells.push_back(line.substr(0, end));
            line.remove_prefix(end);
            line.remove_prefix(std::min(line.find_first_not_of(kCellBlanks), line.size()));
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

double TableRows::number(std::size_t column, std::string_view name) const {
    constexpr std::size_t kLongest = 40;
    const std::string_view cell = mCells[column];
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
    message += name;
    fail(message + "; expected a number");
}

void TableRows::requireWidth(std::size_t width) const {
    if (mCells.size() == width) return;
    fail("has " + std::to_string(mCells.size()) + " columns; expected " + std::to_string(width) +
         ", as in the first line");
}

bool TableRows::isOfWords() const {
    return std::none_of(mCells.begin(), mCells.end(),
                        [](std::string_view cell) { return numberOf(cell).has_value(); });
}

bool TableRows::isOfNumbers() const {
    return std::all_of(mCells.begin(), mCells.end(),
                       [](std::string_view cell) { return numberOf(cell).has_value(); });
}

}  // namespace bandvox
