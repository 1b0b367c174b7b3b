#pragma once

#include "option_table.h"
#include "option_values.h"

#include <string>
#include <vector>

namespace bandvox::app {

/// What the user gave to a command. Options are read as OptionValues has it.
class CommandLine : public OptionValues {
  public:
    /// Throws Error(ErrorKind::Usage) for unknown, repeated, valueless options. Abbreviated names
    /// are unknown.
    CommandLine(const CommandTable& table, const std::vector<std::string>& arguments);

    /// The text given to an option that must be there.
    std::string requiredText(const std::string& option) const;

    /// Throws Error(ErrorKind::Usage) unless exactly the table's positional arguments are there.
    void requirePositionals() const;
    const std::string& positional(std::size_t i) const { return mPositionals[i]; }
    /// All of them, of a command whose last one may be repeated.
    const std::vector<std::string>& positionals() const { return mPositionals; }

    const CommandTable& table() const { return mTable; }

  private:
    const CommandTable& mTable;
    std::vector<std::string> mPositionals;
};

}  // namespace bandvox::app
