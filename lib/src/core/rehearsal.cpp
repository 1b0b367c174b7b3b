#include "core/rehearsal.h"

#include <bandvox/core/error.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>

namespace bandvox {

namespace {

/// Bytes of addresses that the process has.
std::int64_t addressesInUse() {
    std::int64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * sysconf(_SC_PAGESIZE);
}

void setLimit(int resource, std::int64_t soft, std::int64_t hard) {
    const rlimit limit{static_cast<rlim_t>(soft), static_cast<rlim_t>(hard)};
    setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// The process that is copied.
struct Original {
    pid_t process = 0;
    std::int64_t bytes = 0;  ///< of addresses in use
};

/// In the copy: becomes one that harms nobody, works, and writes what went wrong to `out`.
[[noreturn]] void workAndEnd(const std::function<std::string()>& work,
                             const RehearsalLimits& limits, const Original& original, int out) {
    // It ends with the process that waits for it, and leaves the user's wishes to that.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != original.process) _exit(1);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGABRT, SIGSEGV}) {
        std::signal(signal, SIG_DFL);
    }
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere >= 0) {
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
            dup2(nowhere, stream);
        }
    }
    setLimit(RLIMIT_CORE, 0, 0);
    // Beyond the softer limit comes a signal of its own.
    setLimit(RLIMIT_CPU, limits.seconds, limits.seconds + 5);
    if (limits.bytes > 0) {
        setLimit(RLIMIT_AS, original.bytes + limits.bytes, original.bytes + limits.bytes);
    }
    std::string wrong;
    try {
        wrong = work();
    } catch (const std::bad_alloc&) {
        wrong = "asked for more memory than such a file can need";
    } catch (const std::exception& error) {
        wrong = error.what();
    }
    // More than a pipe holds could wait for a reader.
    const std::size_t size = std::min<std::size_t>(wrong.size(), 4000);
    const bool isWritten = write(out, wrong.data(), size) == static_cast<ssize_t>(size);
    _exit(isWritten ? 0 : 1);
}

using Clock = std::chrono::steady_clock;

/// What a copy had to say.
struct Spoken {
    std::string words;
    bool isTooLate = false;  ///< it was ended for waiting, as for a lock that nobody holds any more
};

/// Waits until the other end of the pipe is closed, which the copy's end does at the latest.
Spoken readAll(int in, pid_t copy, Clock::time_point latest, Progress& progress) {
    constexpr int kMilliseconds = 20;
    Spoken spoken;
    std::string& all = spoken.words;
    std::array<char, 4096> part;
    while (true) {
        pollfd wanted{in, POLLIN, 0};
        if (poll(&wanted, 1, kMilliseconds) > 0) {
            const ssize_t size = read(in, part.data(), part.size());
            if (size > 0) all.append(part.data(), static_cast<std::size_t>(size));
            if (size == 0 || (size < 0 && errno != EINTR)) return spoken;
        }
        spoken.isTooLate = spoken.isTooLate || Clock::now() > latest;
        if (spoken.isTooLate || progress.interrupted()) kill(copy, SIGKILL);
    }
}

}  // namespace

std::string rehearse(const std::function<std::string()>& work, const RehearsalLimits& limits,
                     Progress& progress) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return {};
    const Original original{getpid(), addressesInUse()};
    // Of a machine that does much else the copy may get a tenth.
    const auto latest = Clock::now() + 10 * std::chrono::seconds(limits.seconds);
    const pid_t copy = fork();
    if (copy == 0) {
        close(ends[0]);
        workAndEnd(work, limits, original, ends[1]);
    }
    close(ends[1]);
    Spoken spoken;
    int status = 0;
    if (copy > 0) {
        spoken = readAll(ends[0], copy, latest, progress);
        while (waitpid(copy, &status, 0) < 0 && errno == EINTR) {
        }
    }
    close(ends[0]);
    progress.throwIfInterrupted();
    if (!WIFSIGNALED(status)) return spoken.words;
    const int signal = WTERMSIG(status);
    if (signal == SIGKILL && !spoken.isTooLate) {
        // Nobody but the system does that, which has no other way to get memory back.
        throw Error(ErrorKind::Memory,
                    "the system ended a process of this program that read a "
                    "file, probably for want of memory");
    }
    if (signal == SIGXCPU || signal == SIGKILL) {
        return "took more than " + std::to_string(limits.seconds) + " seconds";
    }
    return "crashed with signal " + std::to_string(signal);
}

}  // namespace bandvox
