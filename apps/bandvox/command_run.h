#pragma once

#include "command_line.h"
#include "command_progress.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bandvox::app {

/// One run of a command: what the shared options ask for.
class CommandRun {
  public:
    /// Throws Error(ErrorKind::Usage) for shared options out of range and if two of input, output
    /// and statistics are the same file, Error(ErrorKind::Runtime) if the statistics could not be
    /// written.
    explicit CommandRun(const CommandLine& line);
    ~CommandRun();
    CommandRun(const CommandRun&) = delete;
    CommandRun& operator=(const CommandRun&) = delete;

    Progress& progress() { return mProgress; }
    /// Part `index` of `count` of the command begins, each like the others.
    void beginPart(std::size_t index, std::size_t count) { mProgress.beginPart(index, count); }
    bool verbose() const { return mVerbose; }

    /// Prints a line on the standard error, unless --quiet.
    void say(const std::string& message);
    /// Prints an error on the standard error that does not end the command.
    void sayError(const std::string& message);
    /// Prints a line on the standard error if --verbose.
    void sayMore(const std::string& message);

    /// Prints each warning. Under --strict throws Error(strictKind) if there is one.
    void warn(const std::vector<std::string>& warnings, ErrorKind strictKind);

    /// Adds an entry to "counts" of the statistics.
    void count(const std::string& name, const nlohmann::json& value);

    /// Lets `write` write to `output` and commits that, unless the user wants to stop or the
    /// statistics cannot be written. Then finishes. The last step of a command.
    void writeOutput(AtomicFile& output, const std::function<void(AtomicFile&)>& write);

    /// The same for one output of several: commits it, and does not finish.
    void writePart(AtomicFile& output, const std::function<void(AtomicFile&)>& write);

    /// Leaves what takes long to be freed, as a large grid does, to the end of the process, where
    /// all goes at once. Of a command that consists of frames nothing is left.
    void leaveToExit(std::shared_ptr<const void> object);

    /// Writes the statistics if they are asked for. The last step of a command without output, or
    /// with several.
    void finish();

    /// The same, of a command that has failed in part.
    void finishFailed();

    /// From now on the command consists of `count` frames, and what is counted belongs to one of
    /// them: writeOutput no longer finishes, and the statistics have a list of frames.
    void beginFrames(std::size_t count);
    /// Frame `frame` begins.
    void beginFrame(int frame);
    /// It ends with `result` ("written", "skipped", "failed"); what else the statistics are to say.
    void endFrame(const std::string& result, const nlohmann::json& more);

    /// There is nothing to be done for an output, and `why`. In place of writeOutput.
    void skip(const std::string& output, const std::string& why);
    /// True if skip was called for the present frame.
    bool skipped() const { return mSkipped; }

    /// Since the command began.
    double seconds() const;

  private:
    std::string writeFile(AtomicFile& output, const std::function<void(AtomicFile&)>& write);
    void sayWritten(const AtomicFile& output, const std::string& size);
    void writeStatistics();

    std::string mCommand;
    std::chrono::steady_clock::time_point mStart;
    bool mQuiet, mVerbose, mStrict;
    CommandProgress mProgress;
    ThreadLimit mThreads;
    std::int64_t mOutputBytes = 0;
    std::unique_ptr<AtomicFile> mStatistics;
    std::unique_ptr<nlohmann::json> mCounts;
    int mExceptions;         // in flight when the run began
    bool mFinished = false;  // all was done, but for what is said to the standard output

    // Of a command that consists of frames.
    struct Frames;
    std::unique_ptr<Frames> mFrames;
    bool mSkipped = false;
};

/// Writes a command's result to the standard output. A reader that has gone away is no failure;
/// throws Error(ErrorKind::Runtime) if it cannot be written for another reason.
void writeResult(const std::string& text);

/// The lower-case extension of a path, with the dot.
std::string extensionOf(const std::filesystem::path& path);

/// Throws Error(ErrorKind::Usage) unless `path`, given to --output, ends in one of `extensions`, or
/// is a device or a pipe and there is one extension only.
void requireExtension(const std::filesystem::path& path,
                      const std::vector<std::string>& extensions);

}  // namespace bandvox::app
