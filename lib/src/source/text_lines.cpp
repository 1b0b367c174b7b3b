#include "source/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace bandvox {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

std::string quoted(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    return "\"" + std::string(word.substr(0, kLongest)) + (word.size() > kLongest ? "...\"" : "\"");
}

std::string_view withoutPlus(std::string_view word) {
    return word.starts_with('+') ? word.substr(1) : word;
}

}  // namespace

std::string_view TextLines::takeLine() {
    const std::string_view text(mFile.bytes);
    const std::size_t end = std::min(text.find('\n', mPosition), text.size());
    const std::string_view line = text.substr(mPosition, end - mPosition);
    mPosition = std::min(end + 1, text.size());
    ++mNumber;
    return line;
}

void TextLines::appendWords(std::string_view text) {
    text = text.substr(0, text.find('#'));
    while (true) {
        const std::size_t begin = text.find_first_not_of(kBlanks);
        if (begin == std::string_view::npos) return;
        const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
        mWords.push_back(text.substr(begin, end - begin));
        text.remove_prefix(end);
    }
}

bool TextLines::next() {
    mWords.clear();
    if (mPosition >= mFile.bytes.size()) return false;
    appendWords(takeLine());
    return true;
}

bool TextLines::nextWithWords() {
    while (next()) {
        if (!mWords.empty()) return true;
    }
    return false;
}

bool TextLines::joinContinued() {
    if (mWords.empty() || !mWords.back().ends_with('\\')) return false;
    mWords.back().remove_suffix(1);
    if (mWords.back().empty()) mWords.pop_back();
    if (mPosition >= mFile.bytes.size()) return false;
    appendWords(takeLine());
    return true;
}

double TextLines::coordinate(std::size_t i) const {
    const std::string_view word = withoutPlus(mWords[i]);
    double value = 0.0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    // A number too small for a double is as good as 0.
    const bool isSmall =
        word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
    if (status == std::errc::result_out_of_range && isSmall) return 0.0;
    if (status == std::errc::invalid_argument || end != word.data() + word.size()) {
        fail("has " + quoted(mWords[i]) + "; expected a number");
    }
    if (status == std::errc::result_out_of_range ||
        !(std::abs(value) <= std::numeric_limits<float>::max())) {
        fail("has the coordinate " + std::string(mWords[i]) + "; expected a finite number");
    }
    return value;
}

std::int64_t TextLines::integer(std::size_t i) const {
    const auto integer = leadingInteger(mWords[i]);
    if (!integer || !integer->rest.empty()) {
        fail("has " + quoted(mWords[i]) + "; expected a whole number");
    }
    return integer->value;
}

std::optional<LeadingInteger> leadingInteger(std::string_view word) {
    word = withoutPlus(word);
    std::int64_t value = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (status != std::errc()) return std::nullopt;
    return LeadingInteger{value, word.substr(static_cast<std::size_t>(end - word.data()))};
}

void PointUse::use(std::size_t point) {
    if (point >= mUsed.size()) mUsed.resize(point + 1, false);
    mUsed[point] = true;
}

void PointUse::finish(const FileContents& file, std::vector<std::string>& warnings) const {
    const auto unused = std::count(mUsed.begin(), mUsed.end(), false);
    if (unused == 0) return;
    const std::string found = std::to_string(unused) + " of its " + std::to_string(mUsed.size()) +
                              " points are in no face";
    if (!file.bytes.ends_with('\n')) {
        file.fail("is cut short: it does not end with a newline, and " + found);
    }
    warnings.push_back(found);
}

}  // namespace bandvox
