#pragma once

#include "option_table.h"

#include <openvdb/Types.h>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox::app {

/// Numbers that an option accepts.
struct Range {
    double low = -std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::max();
    bool lowOpen = false;   ///< `low` itself is not accepted
    bool highOpen = false;  ///< `high` itself is not accepted

    bool contains(double value) const;
    /// In words, after "expected a number".
    std::string text() const;
};

/// What the user gave to a command, as text, and strict readings of it. A reading throws
/// Error(ErrorKind::Usage) that names the option, what was found and what was expected.
class CommandLine {
  public:
    /// Throws Error(ErrorKind::Usage) for unknown, repeated, valueless options. Abbreviated names
    /// are unknown.
    CommandLine(const CommandTable& table, const std::vector<std::string>& arguments);

    /// True if the option was given.
    bool has(const std::string& option) const { return mValues.contains(option); }
    /// The text given to an option, or nothing.
    std::optional<std::string> text(const std::string& option) const;
    /// The text given to an option that must be there.
    std::string requiredText(const std::string& option) const;

    double number(const std::string& option, const Range& range, double fallback) const;
    int wholeNumber(const std::string& option, int low, int high, int fallback) const;
    /// Three numbers separated by commas.
    std::optional<openvdb::Vec3d> vector(const std::string& option, const Range& range = {}) const;
    /// Two whole numbers separated by an x.
    std::optional<openvdb::Vec2i> size(const std::string& option, int low, int high) const;
    /// Which of `choices` was given; `fallback` if the option was not.
    std::size_t choice(const std::string& option, const std::vector<std::string>& choices,
                       std::size_t fallback) const;

    /// Throws Error(ErrorKind::Usage) unless exactly the table's positional arguments are there.
    void requirePositionals() const;
    const std::string& positional(std::size_t i) const { return mPositionals[i]; }

    const CommandTable& table() const { return mTable; }

  private:
    const CommandTable& mTable;
    std::map<std::string, std::string> mValues;  // by long name; a flag's value is empty
    std::vector<std::string> mPositionals;
};

}  // namespace bandvox::app
