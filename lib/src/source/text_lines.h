#pragma once

#include "source/file_integrity.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// Goes through the lines of a text and the words of a line.
class TextLines {
  public:
    /// Starts at a byte of the file, where the line with this number begins.
    explicit TextLines(const FileContents& file, std::size_t begin = 0, std::size_t lineNumber = 0)
        : mFile(file), mPosition(begin), mNumber(lineNumber) {}

    /// Goes to the next line, which may be empty; false at the end.
    bool next();

    /// Goes to the next line that has a word before the first '#'; false at the end.
    bool nextWithWords();

    /// If the line ends with a backslash, appends the one that follows; false otherwise.
    bool joinContinued();

    /// The words of the line up to the first '#'.
    const std::vector<std::string_view>& words() const { return mWords; }

    /// The first byte after the line.
    std::size_t position() const { return mPosition; }

    std::size_t number() const { return mNumber; }

    /// Complains about this line.
    [[noreturn]] void fail(const std::string& what) const {
        mFile.fail("line " + std::to_string(mNumber) + " " + what);
    }

    /// Word i as a number that single precision can hold; complains otherwise.
    double coordinate(std::size_t i) const;

    /// Word i as a whole number; complains otherwise.
    std::int64_t integer(std::size_t i) const;

  private:
    std::string_view takeLine();
    void appendWords(std::string_view text);

    const FileContents& mFile;
    std::size_t mPosition;
    std::size_t mNumber;
    std::vector<std::string_view> mWords;
};

/// The whole number that the word begins with, and what follows it; nothing if it does not.
struct LeadingInteger {
    std::int64_t value;
    std::string_view rest;
};
std::optional<LeadingInteger> leadingInteger(std::string_view word);

/// Notes which points faces use, and complains about points that are not there.
class PointUse {
  public:
    explicit PointUse(std::size_t count = 0) : mUsed(count, false) {}

    void use(std::size_t point);
    void setCount(std::size_t count) { mUsed.resize(count, false); }

    /// Warns of points that no face uses; complains if the text ends without a newline as well,
    /// which together say that it was cut short.
    void finish(const FileContents& file, std::vector<std::string>& warnings) const;

  private:
    std::vector<bool> mUsed;
};

}  // namespace bandvox
