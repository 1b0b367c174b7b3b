#pragma once

#include "source/file_integrity.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// The number that a word is, nothing if it is none. One too small for a double is 0, one too large
/// is infinite.
std::optional<double> numberOf(std::string_view word);

/// The rows of a table in text, one after another: numbers or words separated by semicolons, tabs,
/// commas or blanks, whatever the first row has of these, in this order. Lines that are empty or
/// begin with "#" or "//" are passed over.
class TableRows {
  public:
    explicit TableRows(const FileContents& file) : mFile(file), mRest(file.bytes) {
        if (mRest.starts_with("\xEF\xBB\xBF")) mRest.remove_prefix(3);
    }

    /// Finds the first row, of names or numbers; false if there is none. A comment in the first
    /// line is one if `isHeader` says so of the words in it.
    bool begin(const std::function<bool(const std::vector<std::string>&)>& isHeader);

    /// Goes to the next row; false at the end.
    bool next();

    const std::vector<std::string_view>& cells() const { return mCells; }
    std::vector<std::string> names() const { return {mCells.begin(), mCells.end()}; }
    /// True if all cells of the row are numbers.
    bool isOfNumbers() const;
    /// True if none of them is.
    bool isOfWords() const;
    /// Of the row's line in the file, from 1.
    std::size_t lineNumber() const { return mNumber; }
    std::size_t position() const { return mFile.bytes.size() - mRest.size(); }

    /// Cell `column` as a number; complains otherwise. `name`: what the number is.
    double number(std::size_t column, std::string_view name) const;

    /// Complains unless the row has so many cells.
    void requireWidth(std::size_t width) const;

    /// Complains about this line.
    [[noreturn]] void fail(const std::string& what) const {
        mFile.fail("line " + std::to_string(mNumber) + " " + what);
    }

  private:
    bool takeLine(std::string_view& line);
    void split(std::string_view line);

    const FileContents& mFile;
    std::string_view mRest;
    std::size_t mNumber = 0;
    char mSeparator = ' ';
    std::vector<std::string_view> mCells;
};

}  // namespace bandvox
