#include "command_run.h"

#include "progress_plans.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/version.h>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <map>
#include <utility>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

constexpr int kMostThreads = 4096;

ProgressDisplay displayFor(const CommandLine& line) {
    const std::size_t choice = line.choice("progress", 0);
    const bool isTerminal = isatty(STDERR_FILENO) != 0;
    // A report is soon made, and who reads it wants no other lines.
    const bool hasOutput = findOption(line.table(), "output") != nullptr;
    const bool isWanted =
        choice == 1 || (choice == 0 && !line.has("quiet") && (isTerminal || hasOutput));
    if (!isWanted) return ProgressDisplay::None;
    return isTerminal ? ProgressDisplay::Bar : ProgressDisplay::Lines;
}

/// True if writing one of them changes the other.
bool isSameFile(const fs::path& a, const fs::path& b) {
    if (a.empty() || b.empty()) return false;
    std::error_code error;
    const fs::path first = followLinks(a);
    const fs::path second = followLinks(b);
    // What goes to /dev/null changes nothing.
    if (fs::is_character_file(first, error)) return false;
    if (fs::equivalent(first, second, error)) return true;
    const fs::path firstName = fs::weakly_canonical(fs::absolute(first), error);
    if (error) return false;
    return firstName == fs::weakly_canonical(fs::absolute(second), error) && !error;
}

/// Throws Error(ErrorKind::Usage) if the output or the statistics are one of the files before.
void requireDistinctFiles(const CommandLine& line) {
    std::vector<std::pair<std::string, fs::path>> files;
    const auto& table = line.table().positionals;
    for (std::size_t i = 0; i < line.positionals().size(); ++i) {
        files.emplace_back(table[std::min(i, table.size() - 1)].name, line.positional(i));
    }
    for (const std::string option : {"environment", "camera-file", "onto", "like", "config"}) {
        if (const auto given = line.text(option)) files.emplace_back("--" + option, *given);
    }
    for (const std::string option : {"output", "stats"}) {
        const auto given = line.text(option);
        if (!given) continue;
        const fs::path path = option == "output" ? outputPath(*given) : fs::path(*given);
        for (const auto& [name, other] : files) {
            if (!isSameFile(path, other)) continue;
            std::string message = "option --" + option;
            message += " is '" + *given + "', the same file as " + name + "; expected another one";
            throw Error(ErrorKind::Usage, message);
        }
        files.emplace_back("--" + option, path);
    }
}

nlohmann::ordered_json stagesAsJson(const std::vector<StageTime>& stages) {
    auto list = nlohmann::ordered_json::array();
    for (const StageTime& stage : stages) {
        list.push_back({{"name", stage.name}, {"seconds", stage.seconds}, {"steps", stage.steps}});
    }
    return list;
}

}  // namespace

struct CommandRun::Frames {
    std::size_t count = 0;
    int now = 0;
    double start = 0;
    std::int64_t totalBytes = 0;  // of the frames before the present one
    std::map<std::string, int> results;
    std::vector<StageTime> stages;  // of all frames, added up
    nlohmann::ordered_json list = nlohmann::ordered_json::array();

    void add(const StageTime& stage) {
        const auto known = std::find_if(stages.begin(), stages.end(), [&](const StageTime& other) {
            return other.name == stage.name;
        });
        if (known == stages.end()) {
            stages.push_back(stage);
        } else {
            known->seconds += stage.seconds;
            known->steps += stage.steps;
        }
    }
};

CommandRun::CommandRun(const CommandLine& line)
    : mCommand(line.table().name),
      mStart(std::chrono::steady_clock::now()),
      mQuiet(line.has("quiet")),
      mVerbose(line.has("verbose")),
      mStrict(line.has("strict")),
      mProgress(displayFor(line)),
      mThreads(line.wholeNumber("threads", 0, kMostThreads, 0)),
      mCounts(std::make_unique<nlohmann::json>(nlohmann::json::object())),
      mExceptions(std::uncaught_exceptions()) {
    if (mQuiet && mVerbose) {
        throw Error(ErrorKind::Usage, "--quiet and --verbose exclude each other");
    }
    mProgress.expect(expectedStages(line));
    requireDistinctFiles(line);
    if (const auto path = line.text("stats")) mStatistics = std::make_unique<AtomicFile>(*path);
}

CommandRun::~CommandRun() {
    // What a command still says when it has finished can fail, too.
    if (mFinished && std::uncaught_exceptions() <= mExceptions) mProgress.showDone();
}

void CommandRun::say(const std::string& message) {
    if (mQuiet) return;
    mProgress.erase();
    std::fprintf(stderr, "%s\n", printable(message).c_str());
}

void CommandRun::sayError(const std::string& message) {
    mProgress.erase();
    std::fprintf(stderr, "bandvox: error: %s\n", printable(message).c_str());
}

void CommandRun::sayMore(const std::string& message) {
    if (mVerbose) say(message);
}

void CommandRun::warn(const std::vector<std::string>& warnings, ErrorKind strictKind) {
    if (warnings.empty()) return;
    mProgress.erase();
    const std::string place = mFrames ? "frame " + std::to_string(mFrames->now) + ": " : "";
    for (const std::string& warning : warnings) {
        std::fprintf(stderr, "bandvox: warning: %s\n", printable(place + warning).c_str());
    }
    if (mStrict) {
        const auto count = static_cast<std::int64_t>(warnings.size());
        throw Error(strictKind, formatCount(count, "warning", "warnings") +
                                    ", and --strict takes a warning for a failure");
    }
}

void CommandRun::count(const std::string& name, const nlohmann::json& value) {
    (*mCounts)[name] = value;
}

std::string CommandRun::writeFile(AtomicFile& output,
                                  const std::function<void(AtomicFile&)>& write) {
    mProgress.throwIfInterrupted();
    {
        const ProgressStage stage(mProgress, "write", 0);
        write(output);
    }
    if (output.inPlace()) return {};
    const auto bytes = static_cast<std::int64_t>(fs::file_size(output.temporary()));
    mOutputBytes += bytes;
    count("output_bytes", mOutputBytes);
    return ", " + formatBytes(bytes);
}

void CommandRun::sayWritten(const AtomicFile& output, const std::string& size) {
    const bool isStandardOutput = output.target() == "/dev/stdout";
    say("wrote    " + (isStandardOutput ? "the standard output" : output.target().string()) + size +
        ", after " + formatNumber(seconds(), 3) + " s");
}

void CommandRun::writePart(AtomicFile& output, const std::function<void(AtomicFile&)>& write) {
    const std::string size = writeFile(output, write);
    mProgress.throwIfInterrupted();
    output.commit();
    sayWritten(output, size);
}

void CommandRun::writeOutput(AtomicFile& output, const std::function<void(AtomicFile&)>& write) {
    if (mFrames) return writePart(output, write);
    const std::string size = writeFile(output, write);
    // Both files are whole and on the disk before either of them gets its name, and the output
    // gets it last: there is none without the statistics that were asked for.
    output.complete();
    if (mStatistics) {
        writeStatistics();
        mStatistics->complete();
    }
    mProgress.throwIfInterrupted();
    if (mStatistics) mStatistics->commit();
    output.commit();
    sayWritten(output, size);
    mFinished = true;
}

void CommandRun::leaveToExit(std::shared_ptr<const void> object) {
    static auto* const left = new std::vector<std::shared_ptr<const void>>;
    if (!mFrames) left->push_back(std::move(object));
}

void CommandRun::finish() {
    mProgress.throwIfInterrupted();
    if (mStatistics) {
        writeStatistics();
        mStatistics->commit();
    }
    mFinished = true;
}

void CommandRun::finishFailed() {
    finish();
    mFinished = false;
}

void CommandRun::skip(const std::string& output, const std::string& why) {
    mSkipped = true;
    say("skipped  " + output + ": " + why);
    count("skipped", true);
    if (!mFrames) finish();
}

void CommandRun::beginFrames(std::size_t count) {
    mFrames = std::make_unique<Frames>();
    mFrames->count = count;
}

void CommandRun::beginFrame(int frame) {
    mProgress.beginPart(mFrames->list.size(), mFrames->count);
    mProgress.takeStages();
    mFrames->now = frame;
    mFrames->start = seconds();
    mFrames->totalBytes += mOutputBytes;
    mOutputBytes = 0;
    mSkipped = false;
    *mCounts = nlohmann::json::object();
}

void CommandRun::endFrame(const std::string& result, const nlohmann::json& more) {
    nlohmann::ordered_json entry;
    entry["frame"] = mFrames->now;
    entry["result"] = result;
    for (const auto& [name, value] : more.items()) entry[name] = value;
    entry["seconds"] = seconds() - mFrames->start;
    entry["stages"] = stagesAsJson(mProgress.stages());
    entry["counts"] = *mCounts;
    mFrames->list.push_back(std::move(entry));
    for (const StageTime& stage : mProgress.takeStages()) mFrames->add(stage);
    ++mFrames->results[result];
}

double CommandRun::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - mStart).count();
}

void CommandRun::writeStatistics() {
    nlohmann::ordered_json statistics;
    statistics["command"] = mCommand;
    statistics["version"] = version();
    statistics["threads"] = threadCount();
    statistics["seconds"] = seconds();
    statistics["peak_memory_bytes"] = peakMemory();
    statistics["stages"] = stagesAsJson(mFrames ? mFrames->stages : mProgress.stages());
    if (mFrames) {
        nlohmann::ordered_json counts;
        for (const char* result : {"written", "skipped", "failed"}) {
            counts[std::string("frames_") + result] = mFrames->results[result];
        }
        counts["output_bytes"] = mFrames->totalBytes + mOutputBytes;
        statistics["counts"] = counts;
        statistics["frames"] = mFrames->list;
    } else {
        statistics["counts"] = *mCounts;
    }

    std::ofstream file = mStatistics->open();
    file << statistics.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.close();
    if (!file) {
        throw Error(ErrorKind::Runtime, "cannot write the statistics to '" +
                                            mStatistics->target().string() +
                                            "': " + std::strerror(errno));
    }
}

void writeResult(const std::string& text) {
    const char* rest = text.data();
    std::size_t left = text.size();
    while (left > 0) {
        const ssize_t written = ::write(STDOUT_FILENO, rest, left);
        if (written < 0) {
            if (errno == EINTR) continue;
            if (errno == EPIPE) return;
            throw Error(ErrorKind::Runtime, std::string("cannot write to the standard output: ") +
                                                std::strerror(errno));
        }
        rest += written;
        left -= static_cast<std::size_t>(written);
    }
}

std::string extensionOf(const fs::path& path) {
    return lowerCase(path.extension().string());
}

void requireExtension(const fs::path& path, const std::vector<std::string>& extensions) {
    if (std::find(extensions.begin(), extensions.end(), extensionOf(path)) != extensions.end()) {
        return;
    }
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    const bool stream =
        fs::is_character_file(status) || fs::is_fifo(status) || path.string().starts_with("/dev/");
    if (stream && extensions.size() == 1) return;
    const bool isBare = path.filename().string().starts_with('.') && !path.has_extension();
    throw Error(ErrorKind::Usage,
                "option --output is '" + path.string() + "'; expected a name that ends in " +
                    joined(extensions, " or ") + (isBare ? " and has something before it" : ""));
}

}  // namespace bandvox::app
