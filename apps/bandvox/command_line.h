#pragma once

#include "option_table.h"
#include "option_values.h"

#include <set>
#include <string>
#include <vector>

namespace bandvox::app {

/// What the user gave to a command. Options are read as OptionValues has it.
class CommandLine : public OptionValues {
  public:
    /// Takes the options of a file, too, if --config names one; what is given here wins. A flag may
    /// be given as --flag=true or, to rule out what a file says, --flag=false. Throws
    /// Error(ErrorKind::Usage) for unknown, repeated, valueless options, and what readConfigFile
    /// does. Abbreviated names are unknown.
    CommandLine(const CommandTable& table, const std::vector<std::string>& arguments);

    using OptionValues::choice;
    /// Which of the words that the table lists was given; `fallback` if the option was not.
    std::size_t choice(const std::string& option, std::size_t fallback) const;

    /// The text given to an option that must be there.
    std::string requiredText(const std::string& option) const;

    /// Throws Error(ErrorKind::Usage) unless exactly the table's positional arguments are there.
    void requirePositionals() const;
    const std::string& positional(std::size_t i) const { return mPositionals[i]; }
    /// All of them, of a command whose last one may be repeated.
    const std::vector<std::string>& positionals() const { return mPositionals; }

    const CommandTable& table() const { return mTable; }

    /// True if an option, or one that rules it out, was given, if only as --flag=false.
    bool decides(const std::string& option) const;

    /// Sets an option to what a file of settings says, unless it has been decided.
    void setUndecided(const std::string& option, const std::string& value,
                      const std::string& origin);

    /// The same with another first argument and another --output.
    CommandLine withFiles(const std::string& input, const std::string& output) const;

  private:
    void parse(const std::vector<std::string>& arguments);

    const CommandTable& mTable;
    std::vector<std::string> mPositionals;
    std::set<std::string> mDecided;
};

}  // namespace bandvox::app
