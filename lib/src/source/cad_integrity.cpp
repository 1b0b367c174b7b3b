#include "source/cad_integrity.h"

#include "core/letter_case.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace bandvox {
namespace {

bool isNoNumber(std::string_view word) {
    if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
    const std::string lower = inLowerCase(std::string(word.substr(0, 16)));
    return lower == "nan" || lower == "inf" || lower == "infinity";
}

// Lengths, in any unit, beyond which Open CASCADE crashes, or takes for good: it works to 1e-7.
constexpr double kFarthest = 1e12;

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// How long the number at the beginning of a text is, with all its digits; 0 if there is none.
// Fortran's exponents have a D.
std::size_t lengthOfNumber(std::string_view text) {
    const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : ' '; };
    const auto isSign = [](char c) { return c == '+' || c == '-'; };
    std::size_t end = isSign(at(0)) ? 1 : 0;
    bool hasDigits = false;
    for (; isDigit(at(end)) || at(end) == '.'; ++end) hasDigits |= isDigit(at(end));
    if (!hasDigits) return 0;
    if (std::string_view("EeDd").find(at(end)) == std::string_view::npos) return end;
    const std::size_t exponent = end + (isSign(at(end + 1)) ? 2 : 1);
    if (!isDigit(at(exponent))) return end;
    for (end = exponent; isDigit(at(end));) ++end;
    return end;
}

// Whether a number that a double cannot hold is too large for it, not too small: whether its first
// digit other than 0 is before the point.
bool isHuge(std::string_view number) {
    const std::size_t letter = std::min(number.find('E'), number.size());
    const std::size_t point = std::min(number.find('.'), letter);
    const std::size_t first = number.find_first_of("123456789");
    std::string_view digits = number.substr(std::min(letter + 1, number.size()));
    const bool isNegative = digits.starts_with('-');
    if (isNegative || digits.starts_with('+')) digits.remove_prefix(1);
    std::int64_t exponent = 0;
    const auto status = std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec;
    if (status == std::errc::result_out_of_range) return !isNegative;
    if (isNegative) exponent = -exponent;
    return static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) + exponent > 0;
}

// Refuses the number at the beginning of a text, if there is one, for being too large.
void requireNumberInRange(const FileContents& file, std::string_view text) {
    const std::string given(text.substr(0, lengthOfNumber(text)));
    std::string number = given.substr(given.starts_with('+') ? 1 : 0);
    for (char& c : number) {
        if (std::string_view("eDd").find(c) != std::string_view::npos) c = 'E';
    }
    double value = 0;
    const auto status = std::from_chars(number.data(), number.data() + number.size(), value).ec;
    const bool isFar =
        status == std::errc::result_out_of_range ? isHuge(number) : !(std::abs(value) <= kFarthest);
    if (isFar) file.fail("holds the number " + given + "; expected none beyond 1e12");
}

[[noreturn]] void failAtWord(const FileContents& file, std::string_view word) {
    file.fail("holds \"" + std::string(word) + "\"; expected finite numbers");
}

bool isLetter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// What the parentheses around a place in a STEP file say of numbers there.
class StepParentheses {
  public:
    // `word`: the keyword before it, if there is one.
    void open(std::string_view word) {
        const bool isItem = word.ends_with("REPRESENTATION_ITEM");
        mIsItem |= isItem;
        Kind kind = mKinds.empty() ? Kind{} : mKinds.back();
        // A measure with its unit may be a factor of lengths, whatever kind it says that it is.
        kind.isUnit |= !mIsItem && word.ends_with("MEASURE_WITH_UNIT");
        if (!word.empty()) {
            const bool isOfShape =
                word.ends_with("LENGTH_MEASURE") || word.ends_with("ANGLE_MEASURE");
            kind.isProperty = isItem || (word.ends_with("_MEASURE") && !isOfShape);
        }
        mKinds.push_back(kind);
    }
    void close() {
        if (!mKinds.empty()) mKinds.pop_back();
    }
    void endEntity() {
        mKinds.clear();
        mIsItem = false;
    }

    // Whether a number here is no length and no other part of a shape: a volume, say.
    bool holdProperty() const {
        return !mKinds.empty() && mKinds.back().isProperty && !mKinds.back().isUnit;
    }

  private:
    struct Kind {
        bool isUnit = false, isProperty = false;
    };
    std::vector<Kind> mKinds;
    bool mIsItem = false;  // whether an entity is a property of something
};

// Goes through the text outside of strings and comments. Open CASCADE follows names that are not
// defined to nowhere.
void requireSoundStep(const FileContents& file) {
    const std::string_view text(file.bytes);
    if (text.substr(0, 4096).find("ISO-10303-21") == std::string_view::npos) {
        file.fail("does not begin with ISO-10303-21; expected a STEP file");
    }
    if (text.rfind("END-ISO-10303-21") == std::string_view::npos) {
        file.fail("ends before END-ISO-10303-21; expected the rest of a STEP file");
    }
    std::vector<std::uint64_t> defined, used;
    StepParentheses parentheses;
    std::string_view word;  // before a parenthesis
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '\'' || c == '"') {
            i = std::min(text.find(c, i + 1), text.size() - 1) + 1;
        } else if (text.compare(i, 2, "/*") == 0) {
            i = std::min(text.find("*/", i + 2), text.size() - 2) + 2;
        } else if (c == '#') {
            std::uint64_t name = 0;
            const char* const end = text.data() + text.size();
            const char* const after = std::from_chars(text.data() + i + 1, end, name).ptr;
            i = static_cast<std::size_t>(after - text.data());
            const std::size_t next = text.find_first_not_of(" \t\r\n", i);
            const bool isDefined = next != std::string_view::npos && text[next] == '=';
            (isDefined ? defined : used).push_back(name);
        } else if (isDigit(c)) {
            const std::string_view rest = text.substr(i);
            if (!parentheses.holdProperty()) requireNumberInRange(file, rest);
            i += lengthOfNumber(rest);
        } else if (isLetter(c)) {
            const std::size_t begin = i;
            while (i < text.size() && isLetter(text[i])) ++i;
            word = text.substr(begin, i - begin);
            if (isNoNumber(word)) failAtWord(file, word);
        } else {
            if (c == '(') parentheses.open(word);
            if (c == ')') parentheses.close();
            if (c == ';') parentheses.endEntity();
            if (std::isspace(static_cast<unsigned char>(c)) == 0) word = {};
            ++i;
        }
    }
    std::sort(defined.begin(), defined.end());
    for (const std::uint64_t name : used) {
        if (std::binary_search(defined.begin(), defined.end(), name)) continue;
        file.fail("refers to #" + std::to_string(name) +
                  ", which it does not define; expected a whole STEP file");
    }
}

// Open CASCADE believes what lists are said to hold, and may never come to an end of what is not
// there.
void requireSoundBrep(const FileContents& file) {
    const std::string_view text(file.bytes);
    if (text.substr(0, 4096).find("CASCADE Topology V") == std::string_view::npos) {
        file.fail("does not begin with CASCADE Topology; expected a BREP file as text");
    }
    constexpr std::string_view kBlanks = " \t\r\n";
    const auto isList = [](std::string_view word) {
        return word == "Locations" || word == "Curve2ds" || word == "Curves" ||
               word == "Polygon3D" || word == "PolygonOnTriangulations" || word == "Surfaces" ||
               word == "Triangulations" || word == "TShapes";
    };
    // Open CASCADE's own, or twice that: where the curve of an edge has no end.
    const auto isInfinity = [](std::string_view word) {
        if (word.starts_with('-')) word.remove_prefix(1);
        return word == "1e+100" || word == "2e+100";
    };
    bool isEdge = false;
    std::string_view before, last[2];
    std::size_t words = 0;  // after the last star
    for (std::size_t i = text.find_first_not_of(kBlanks); i < text.size();) {
        const std::size_t end = std::min(text.find_first_of(kBlanks, i), text.size());
        const std::string_view word = text.substr(i, end - i);
        if (isNoNumber(word)) failAtWord(file, word);
        if (word == "Ed" || word == "*") isEdge = word == "Ed";
        if (!(isEdge && isInfinity(word))) requireNumberInRange(file, word);
        if (isList(before)) {
            std::int64_t count = 0;
            std::from_chars(word.data(), word.data() + word.size(), count);
            if (count < 0 || count > static_cast<std::int64_t>(text.size())) {
                file.fail("announces " + std::string(word) + " " + std::string(before) +
                          "; expected no more than a file of this size can hold");
            }
        }
        if (word == "*") {
            words = 0;
        } else {
            if (words < 2) last[words] = word;
            ++words;
        }
        before = word;
        i = text.find_first_not_of(kBlanks, end);
    }
    // Each shape ends with a star; after the last one comes which of them is the whole.
    const bool isShape =
        words > 1 && last[0].size() > 1 && (last[0][0] == '+' || last[0][0] == '-');
    if (!isShape) {
        file.fail("ends before the shape that it is about; expected the rest of a BREP file");
    }
}

// The parameters of an IGES file are what stands in columns 1 to 64 of lines with P in column 73;
// Open CASCADE also takes damaged lines for such.
void requireIgesNumbersInRange(const FileContents& file) {
    constexpr std::size_t kColumns = 64, kLetter = 72;
    const std::string_view bytes(file.bytes);
    std::string text;
    for (std::size_t begin = 0; begin < bytes.size();) {
        const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
        const std::string_view line = bytes.substr(begin, end - begin);
        const char letter = line.size() > kLetter ? line[kLetter] : 'P';
        if (std::string_view("SGDT").find(letter) == std::string_view::npos) {
            text += line.substr(0, kColumns);
        }
        begin = end + 1;
    }
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t begin = std::min(text.find_first_not_of(' ', i), text.size());
        std::size_t end = std::min(text.find_first_of(",;", begin), text.size());
        const std::string_view word = std::string_view(text).substr(begin, end - begin);
        // As many characters as 5HTHESE has before its H may be anything.
        std::size_t count = 0;
        const char* const after =
            std::from_chars(word.data(), word.data() + word.size(), count).ptr;
        if (after != word.data() + word.size() && after != word.data() && *after == 'H') {
            const std::size_t string = begin + static_cast<std::size_t>(after - word.data()) + 1;
            end = std::min(text.find_first_of(",;", std::min(string + count, text.size())),
                           text.size());
        } else {
            requireNumberInRange(file, word);
        }
        i = end + 1;
    }
}

void requireWholeIges(const FileContents& file) {
    const std::string& bytes = file.bytes;
    // Column 73 has the section's letter: Start, or Compressed or Binary, which are rare.
    constexpr std::size_t kLetter = 72;
    if (bytes.size() <= kLetter || bytes[kLetter] != 'S') {
        file.fail("has no S in column 73 of its first line; expected an IGES file as text");
    }
    const auto end = bytes.find_last_not_of(" \t\r\n");
    const auto line = bytes.rfind('\n', end) + 1;
    if (end < line + kLetter || bytes[line + kLetter] != 'T') {
        file.fail("ends before the line with T in column 73; expected the rest of an IGES file");
    }
}

}  // namespace

void requireSoundCadFile(const FileContents& file) {
    const std::string extension = lowerExtension(file.path);
    if (file.bytes.empty()) file.fail("is empty; expected a part");
    if (extension == ".step" || extension == ".stp") return requireSoundStep(file);
    if (extension == ".brep") return requireSoundBrep(file);
    requireWholeIges(file);
    requireIgesNumbersInRange(file);
}

}  // namespace bandvox
