#include "command_run.h"

#include "words.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/version.h>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace bandvox::app {
namespace {

constexpr int kMostThreads = 4096;

bool wantsProgress(const CommandLine& line) {
    switch (line.choice("progress", {"auto", "always", "never"}, 0)) {
        case 1:
            return true;
        case 2:
            return false;
        default:
            return isatty(STDERR_FILENO) != 0 && !line.has("quiet");
    }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

}  // namespace

CommandRun::CommandRun(const CommandLine& line)
    : mCommand(line.table().name),
      mStart(std::chrono::steady_clock::now()),
      mQuiet(line.has("quiet")),
      mVerbose(line.has("verbose")),
      mStrict(line.has("strict")),
      mProgress(wantsProgress(line)),
      mThreads(line.wholeNumber("threads", 0, kMostThreads, 0)),
      mCounts(std::make_unique<nlohmann::json>(nlohmann::json::object())) {
    if (mQuiet && mVerbose) {
        throw Error(ErrorKind::Usage, "--quiet and --verbose exclude each other");
    }
    if (const auto path = line.text("stats")) mStatistics = std::make_unique<AtomicFile>(*path);
}

CommandRun::~CommandRun() = default;

void CommandRun::say(const std::string& message) {
    if (mQuiet) return;
    mProgress.erase();
    std::fprintf(stderr, "%s\n", message.c_str());
}

void CommandRun::sayMore(const std::string& message) {
    if (mVerbose) say(message);
}

void CommandRun::warn(const std::vector<std::string>& warnings, ErrorKind strictKind) {
    if (warnings.empty()) return;
    mProgress.erase();
    for (const std::string& warning : warnings) {
        std::fprintf(stderr, "bandvox: warning: %s\n", warning.c_str());
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

void CommandRun::writeOutput(AtomicFile& output, const std::filesystem::path& target,
                             const std::function<void(const std::filesystem::path&)>& write) {
    mProgress.throwIfInterrupted();
    try {
        const ProgressStage stage(mProgress, "write", 0);
        write(output.temporary());
    } catch (const Error& error) {
        // The user knows the target's name, not the temporary one.
        throw Error(error.kind(),
                    replaced(error.what(), output.temporary().string(), target.string()));
    }
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(output.temporary()));
    count("output_bytes", bytes);
    if (mStatistics) writeStatistics();
    mProgress.throwIfInterrupted();
    output.commit();
    if (mStatistics) mStatistics->commit();
    say("wrote    " + target.string() + ", " + formatBytes(bytes) + ", after " +
        formatNumber(seconds(), 3) + " s");
}

void CommandRun::finish() {
    mProgress.throwIfInterrupted();
    if (!mStatistics) return;
    writeStatistics();
    mStatistics->commit();
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
    statistics["stages"] = nlohmann::ordered_json::array();
    for (const StageTime& stage : mProgress.stages()) {
        statistics["stages"].push_back(
            {{"name", stage.name}, {"seconds", stage.seconds}, {"steps", stage.steps}});
    }
    statistics["counts"] = *mCounts;

    std::ofstream file(mStatistics->temporary(), std::ios::binary);
    file << statistics.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.close();
    if (!file) {
        throw Error(ErrorKind::Runtime, "cannot write the statistics to '" +
                                            mStatistics->temporary().string() +
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

std::string extensionOf(const std::filesystem::path& path) {
    return lowerCase(path.extension().string());
}

void requireExtension(const std::filesystem::path& path,
                      const std::vector<std::string>& extensions) {
    if (std::find(extensions.begin(), extensions.end(), extensionOf(path)) != extensions.end()) {
        return;
    }
    throw Error(ErrorKind::Usage, "option --output is '" + path.string() +
                                      "'; expected a name that ends in " +
                                      joined(extensions, " or "));
}

}  // namespace bandvox::app
