#pragma once

#include <stdexcept>
#include <string>

namespace bandvox {

/// What went wrong, numbered as the command line's exit status.
enum class ErrorKind {
    Runtime = 1,        ///< failed while running: disk full, a worker died
    Usage = 2,          ///< wrong options
    Input = 3,          ///< the input cannot be used: missing, malformed, wrong kind
    Result = 4,         ///< the result would be empty or worse than the tolerance asked for
    Memory = 5,         ///< not enough memory
    Interrupted = 130,  ///< the user asked to stop
};

/// The one exception type that the library throws on purpose. The text says what was found,
/// where, and what was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), mKind(kind) {}

    ErrorKind kind() const { return mKind; }
    int exitStatus() const { return static_cast<int>(mKind); }

  private:
    ErrorKind mKind;
};

}  // namespace bandvox
