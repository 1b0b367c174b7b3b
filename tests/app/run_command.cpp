#include "run_command.h"

#include "build_places.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace bandvox::app_test {

namespace fs = std::filesystem;

namespace {

constexpr int kCannotRun = 127;
constexpr std::chrono::milliseconds kPollInterval{2};

void redirect(int descriptor, const std::string& path, int flags) {
    const int file = open(path.c_str(), flags, 0600);
    if (file < 0 || dup2(file, descriptor) < 0) _exit(kCannotRun);
    close(file);
}

/// In the child: sets all up and becomes the program.
[[noreturn]] void becomeProgram(const std::vector<std::string>& arguments,
                                const RunOptions& options, const fs::path& out,
                                const fs::path& err) {
    redirect(STDIN_FILENO, options.standardInput.value_or("/dev/null"), O_RDONLY);
    redirect(STDERR_FILENO, err, O_WRONLY | O_CREAT);
    if (options.standardOutputClosed) {
        int ends[2];
        if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(kCannotRun);
        close(ends[0]);
        close(ends[1]);
    } else if (options.standardOutput) {
        redirect(STDOUT_FILENO, *options.standardOutput, O_WRONLY);
    } else {
        redirect(STDOUT_FILENO, out, O_WRONLY | O_CREAT);
    }
    if (options.largestFile) {
        const auto bytes = static_cast<rlim_t>(*options.largestFile);
        const rlimit limit{bytes, bytes};
        std::signal(SIGXFSZ, SIG_IGN);
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(kCannotRun);
    }
    if (options.heedPermissions && geteuid() == 0) {
        // Root stays root, but what lets it write everywhere is not passed on to the program.
        if (prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0) != 0) _exit(kCannotRun);
    }
    if (chdir(options.folder.c_str()) != 0) _exit(kCannotRun);
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) {
        pointers.push_back(const_cast<char*>(argument.c_str()));
    }
    pointers.push_back(nullptr);
    execvp(pointers[0], pointers.data());
    _exit(kCannotRun);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "bandvox-test-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    mPath = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(mPath, ignored);
}

std::vector<std::string> TemporaryFolder::contents() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(mPath)) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

RunResult runProgram(const std::vector<std::string>& arguments, const RunOptions& options) {
    const TemporaryFolder streams;
    const fs::path out = streams / "out";
    const fs::path err = streams / "err";
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) becomeProgram(arguments, options, out, err);

    RunResult result;
    int status = 0;
    rusage usage{};
    if (options.signalWhen) {
        int signal = 0;
        while (wait4(child, &status, WNOHANG, &usage) == 0) {
            if (signal == 0) signal = options.signalWhen(readText(err));
            if (signal != 0 && (!result.signalSent || options.signalUntilItEnds)) {
                kill(child, signal);
                result.signalSent = true;
            }
            std::this_thread::sleep_for(kPollInterval);
        }
    } else {
        wait4(child, &status, 0, &usage);
    }
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    constexpr std::int64_t kBytesPerUnit = 1024;
    result.peakBytes = usage.ru_maxrss * kBytesPerUnit;
    result.out = readText(out);
    result.err = readText(err);
    return result;
}

RunResult runBandvox(std::vector<std::string> arguments, const RunOptions& options) {
    arguments.insert(arguments.begin(), build_places::command());
    return runProgram(arguments, options);
}

bool hasProgram(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (access((folder + "/" + name).c_str(), X_OK) == 0) return true;
    }
    return false;
}

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void writeText(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

int countLines(const std::string& text, const std::string& start) {
    std::istringstream lines(text);
    int count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with(start) ? 1 : 0;
    return count;
}

}  // namespace bandvox::app_test
