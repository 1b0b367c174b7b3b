#pragma once

#include <bandvox/core/error.h>

#include <openvdb/Types.h>

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// Of colours, and of places and directions: the squares of more are not finite.
inline constexpr Range kAnyColor{.low = 0, .high = 1e6};
inline constexpr Range kAnyPlace{.low = -1e30, .high = 1e30};

/// Settings as text, by name, and strict readings of them. A reading throws
/// Error(ErrorKind::Usage), or another kind that is asked for, that names the setting, what was
/// found and what was expected.
class OptionValues {
  public:
    /// `title`: what errors put before a name.
    explicit OptionValues(std::string title = "option --", ErrorKind kind = ErrorKind::Usage)
        : mTitle(std::move(title)), mKind(kind) {}

    /// A flag's value is empty. `origin`: where it stands if that is worth telling, as "file:3".
    void set(const std::string& name, const std::string& value, const std::string& origin = {}) {
        mValues[name] = value;
        mOrigins[name] = origin;
    }

    /// What a reading with a fallback gives for a setting that was not given, instead of that. For
    /// has() and text() it stays one that was not given.
    void setDefault(const std::string& name, const std::string& value, const std::string& origin) {
        mDefaults[name] = value;
        if (!has(name)) mOrigins[name] = origin;
    }

    const std::map<std::string, std::string>& all() const { return mValues; }
    const std::string& title() const { return mTitle; }

    /// True if the setting was given.
    bool has(const std::string& name) const { return mValues.contains(name); }
    /// True if it was, and not by a file, which may hold what a command has no use for.
    bool isAsked(const std::string& name) const { return has(name) && origin(name).empty(); }
    /// Where a setting that was given stands; empty if that is not worth telling.
    const std::string& origin(const std::string& name) const { return mOrigins.at(name); }
    /// The text given, or nothing.
    std::optional<std::string> text(const std::string& name) const;
    /// The same, or what setDefault has set.
    std::optional<std::string> textOrDefault(const std::string& name) const;

    double number(const std::string& name, const Range& range, double fallback) const;
    int wholeNumber(const std::string& name, int low, int high, int fallback) const;
    /// A number of bytes, of at least `least`, written as 800M or 1.5G: K, M, G and T are powers of
    /// 1024.
    std::int64_t bytes(const std::string& name, std::int64_t least, std::int64_t fallback) const;
    /// Three numbers separated by commas.
    std::optional<openvdb::Vec3d> vector(const std::string& name, const Range& range = {}) const;
    /// `least` to `most` numbers separated by commas; `expected` is what the error says of them.
    std::optional<std::vector<double>> numbers(const std::string& name, std::size_t least,
                                               std::size_t most, const std::string& expected,
                                               const Range& each = {}) const;
    /// Whole numbers separated by a character.
    std::optional<std::vector<int>> wholeNumbers(const std::string& name, std::size_t count,
                                                 char separator) const;
    /// Two whole numbers separated by an x.
    std::optional<openvdb::Vec2i> size(const std::string& name, int low, int high) const;
    /// Which of `choices` was given; `fallback` if the setting was not.
    std::size_t choice(const std::string& name, const std::vector<std::string>& choices,
                       std::size_t fallback) const;

    /// Which of `choices` were given, separated by commas; all if the setting was not.
    std::vector<bool> choices(const std::string& name,
                              const std::vector<std::string>& choices) const;

    /// Throws the error of a reading: the setting's value is not what was expected.
    [[noreturn]] void fail(const std::string& name, const std::string& expected) const;

  private:
    std::optional<std::string> found(const std::string& name) const;

    std::string mTitle;
    ErrorKind mKind;  // of failures
    std::map<std::string, std::string> mValues;
    std::map<std::string, std::string> mDefaults;
    std::map<std::string, std::string> mOrigins;
};

/// The parts of a text between separators.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace bandvox::app
