#include "core/rehearsal.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace bandvox {
namespace {

constexpr RehearsalLimits kPlenty{100, 0};

std::string rehearseSilently(const std::function<std::string()>& work,
                             const RehearsalLimits& limits = kPlenty) {
    return rehearse(work, limits, silentProgress());
}

TEST(Rehearsal, LeavesThingsAsTheyAre) {
    int number = 1;
    EXPECT_EQ(rehearseSilently([&] {
                  number = 2;
                  std::fputs("nobody reads this", stdout);
                  return std::string();
              }),
              "");
    EXPECT_EQ(number, 1);
}

TEST(Rehearsal, TellsWhatTheWorkSays) {
    EXPECT_EQ(rehearseSilently([] { return std::string("found nothing"); }), "found nothing");
    EXPECT_EQ(rehearseSilently([]() -> std::string { throw std::runtime_error("broke"); }),
              "broke");
    const std::string much(100000, 'x');
    const std::string said = rehearseSilently([&] { return much; });
    EXPECT_GT(said.size(), 1000U);
    EXPECT_TRUE(much.starts_with(said));
}

TEST(Rehearsal, SurvivesACrash) {
    for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
        const std::string said = rehearseSilently([signal]() -> std::string {
            std::signal(signal, SIG_DFL);
            std::raise(signal);
            return "went on";
        });
        EXPECT_EQ(said, "crashed with signal " + std::to_string(signal));
    }
}

TEST(Rehearsal, EndsWhatTakesTooLong) {
    const auto forever = []() -> std::string {
        for (volatile bool goesOn = true; goesOn;) {
        }
        return "ended";
    };
    EXPECT_EQ(rehearseSilently(forever, {1, 0}), "took more than 1 seconds");
}

TEST(Rehearsal, EndsWhatWaitsForNothing) {
    const auto waits = []() -> std::string {
        while (true) pause();
    };
    // The clock's limit is a multiple of the processor's.
    EXPECT_EQ(rehearseSilently(waits, {0, 0}), "took more than 0 seconds");
}

TEST(Rehearsal, DoesNotBlameTheFileForWhatTheSystemEnds) {
    const auto ended = []() -> std::string {
        std::raise(SIGKILL);
        return "went on";
    };
    try {
        rehearseSilently(ended);
        FAIL() << "it was not noticed";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Memory);
    }
}

#ifndef BANDVOX_SANITIZED
TEST(Rehearsal, EndsWhatTakesTooMuchMemory) {
    const auto fill = []() -> std::string {
        try {
            std::vector<char> all(std::size_t(200) << 20, 'x');
            return std::string(1, all.back());
        } catch (const std::bad_alloc&) {
            return "no memory";
        }
    };
    EXPECT_EQ(rehearseSilently(fill, {100, 100'000'000}), "no memory");
    EXPECT_EQ(rehearseSilently(fill, {100, 400'000'000}), "x");
}
#endif

TEST(Rehearsal, StopsWhenAsked) {
    class Impatient : public Progress {
        bool interrupted() const override { return true; }
    } progress;
    const auto forever = []() -> std::string {
        for (volatile bool goesOn = true; goesOn;) {
        }
        return "ended";
    };
    try {
        rehearse(forever, kPlenty, progress);
        FAIL() << "it was not stopped";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

}  // namespace
}  // namespace bandvox
