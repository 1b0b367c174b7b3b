#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/core/progress.h>

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace bandvox {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
    for (const int count : {0, 1, 2, 7, 1000}) {
        std::vector<int> calls(count, 0);
        parallelFor(count, [&](std::int64_t i) { ++calls[i]; });
        for (const int c : calls) EXPECT_EQ(c, 1);
    }
}

TEST(ParallelFor, PassesExceptionsOn) {
    EXPECT_THROW(parallelFor(100,
                             [](std::int64_t i) {
                                 if (i == 31) throw std::runtime_error("here");
                             }),
                 std::runtime_error);
}

TEST(ParallelAsMade, MakesInOrderAndCallsEachOnceWithWhatWasMade) {
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        std::vector<std::int64_t> made(500, -1);
        std::vector<std::atomic<std::int64_t>> seen(500);
        std::int64_t next = 0;
        parallelAsMade(
            500,
            [&](std::int64_t i) {
                EXPECT_EQ(i, next++);
                made[i] = i * i;
            },
            [&](std::int64_t i) { seen[i] += made[i] + 1; });
        for (std::int64_t i = 0; i < 500; ++i) EXPECT_EQ(seen[i], i * i + 1);
    }
    parallelAsMade(
        0, [](std::int64_t) { FAIL(); }, [](std::int64_t) { FAIL(); });
}

// Whichever thread is quicker.
TEST(ParallelAsMade, PassesTheExceptionOfTheLowestOn) {
    const auto failAt = [](std::int64_t place) {
        return [place](std::int64_t i) {
            if (i >= place) throw Error(ErrorKind::Input, std::to_string(i));
        };
    };
    const auto found = [&](std::int64_t make, std::int64_t body) -> std::string {
        try {
            parallelAsMade(100, failAt(make), failAt(body));
            return "none";
        } catch (const Error& error) {
            return error.what();
        }
    };
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        for (int round = 0; round < 50; ++round) {
            EXPECT_EQ(found(100, 100), "none");
            EXPECT_EQ(found(100, 70), "70");
            EXPECT_EQ(found(70, 100), "70");
            EXPECT_EQ(found(0, 0), "0");
            EXPECT_EQ(found(71, 70), "70");
            EXPECT_EQ(found(90, 10), "10");
        }
    }
}

TEST(ParallelAsMade, MakesNoMoreOnceOneHasFailed) {
    const ThreadLimit limit(2);
    std::atomic<int> bodies = 0;
    const auto fail = [](std::int64_t i) {
        if (i == 70) throw Error(ErrorKind::Input, "seventy");
    };
    EXPECT_THROW(parallelAsMade(100, fail, [&](std::int64_t) { ++bodies; }), Error);
    EXPECT_EQ(bodies, 70);
}

TEST(ParallelFor, StaysWithinTheLimit) {
    const ThreadLimit limit(1);
    EXPECT_EQ(threadCount(), 1);
    std::set<std::thread::id> threads;
    parallelFor(200, [&](std::int64_t) { threads.insert(std::this_thread::get_id()); });
    EXPECT_EQ(threads.size(), 1U);
}

TEST(Progress, InterruptionIsAnError) {
    class Stopped : public Progress {
      public:
        bool interrupted() const override { return true; }
    } stopped;
    EXPECT_NO_THROW(silentProgress().throwIfInterrupted());
    try {
        stopped.throwIfInterrupted();
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.exitStatus(), 130);
    }
}

TEST(Memory, NumbersMakeSense) {
    EXPECT_GT(availableMemory(), 1 << 20);
    const std::int64_t before = peakMemory();
    EXPECT_GT(before, 1 << 20);
    std::vector<char> block(64 << 20, 1);
    EXPECT_GT(peakMemory() + block[12345], before + (32 << 20));
    const std::int64_t held = residentMemory();
    EXPECT_GT(held, 32 << 20);
    EXPECT_LE(held, peakMemory() + (1 << 20));
    std::vector<char>().swap(block);
    EXPECT_LT(residentMemory(), held - (32 << 20));
}

TEST(Memory, MoreThanThereIsIsRefusedWithBothNumbers) {
    EXPECT_NO_THROW(requireMemory(1024, "a kilobyte"));
    try {
        requireMemory(1e18, "the moon");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Memory);
        const std::string text = error.what();
        EXPECT_NE(text.find("the moon would need about 1e+09 GB"), std::string::npos) << text;
        EXPECT_NE(text.find("is available"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace bandvox
