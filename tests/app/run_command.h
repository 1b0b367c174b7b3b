#pragma once

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bandvox::app_test {

/// A folder of its own for a test, removed at the end.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return mPath; }
    std::filesystem::path operator/(const std::string& name) const { return mPath / name; }

    /// Names of all that is in it, hidden files included, sorted.
    std::vector<std::string> contents() const;

  private:
    std::filesystem::path mPath;
};

/// How a program is run.
struct RunOptions {
    std::filesystem::path folder = "/";         ///< working folder
    std::optional<std::string> standardInput;   ///< file to use instead of nothing
    std::optional<std::string> standardOutput;  ///< file to use instead of collecting the output
    bool standardOutputClosed = false;          ///< its reader has gone away
    std::optional<long> largestFile;            ///< bytes; writing more fails, as on a full disk
    bool heedPermissions = false;               ///< those of files, even if root runs the tests
    /// Called again and again while the program runs, with what it has said on the standard error
    /// so far; a signal that it returns is sent.
    std::function<int(const std::string& said)> signalWhen;
    /// Sends it again and again until the program ends: two that come before it has had the first
    /// are one to it.
    bool signalUntilItEnds = false;
};

/// What a program did.
struct RunResult {
    int status = -1;  ///< exit status; 128 + s if signal s ended it
    std::string out;  ///< standard output
    std::string err;  ///< standard error
    bool signalSent = false;
    std::int64_t peakBytes = 0;  ///< memory that it had at most
};

/// Runs a program (searched in PATH unless it has a slash) with arguments.
RunResult runProgram(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// Runs the bandvox command that was built.
RunResult runBandvox(std::vector<std::string> arguments, const RunOptions& options = {});

/// True if a program of that name is in PATH.
bool hasProgram(const std::string& name);

std::string readText(const std::filesystem::path& path);
void writeText(const std::filesystem::path& path, const std::string& text);

/// The number of lines that start with `start`.
int countLines(const std::string& text, const std::string& start);

}  // namespace bandvox::app_test
