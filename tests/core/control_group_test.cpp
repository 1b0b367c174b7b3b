#include "core/control_group.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

/// A made-up /proc and /sys.
class ControlGroupTest : public testing::Test {
  protected:
    void SetUp() override {
        root = fs::path(testing::TempDir()) /
               ("bandvox_groups_" +
                std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(root);
        fs::create_directories(root);
    }
    void TearDown() override { fs::remove_all(root); }

    void write(const std::string& path, const std::string& text) const {
        fs::create_directories((root / path).parent_path());
        std::ofstream(root / path) << text;
    }
    void joins(const std::string& memberships) const { write("proc/self/cgroup", memberships); }
    /// A group of version 1.
    void older(const std::string& group, const std::string& limit, const std::string& usage,
               const std::string& cache) const {
        const std::string folder = "sys/fs/cgroup/memory/" + group;
        write(folder + "/memory.limit_in_bytes", limit + "\n");
        write(folder + "/memory.usage_in_bytes", usage + "\n");
        write(folder + "/memory.stat", "cache 77\ninactive_file 1\ntotal_inactive_file " + cache +
                                           "\ntotal_active_file 55\n");
    }
    /// A group of version 2.
    void newer(const std::string& group, const std::string& limit, const std::string& usage,
               const std::string& cache) const {
        const std::string folder = "sys/fs/cgroup/" + group;
        write(folder + "/memory.max", limit + "\n");
        write(folder + "/memory.current", usage + "\n");
        write(folder + "/memory.stat", "anon 12\ninactive_file " + cache + "\nactive_file 5\n");
    }
    std::int64_t available() const { return availableInControlGroups(root); }

    fs::path root;
};

TEST_F(ControlGroupTest, WithoutGroupsNothingIsLimited) {
    EXPECT_EQ(available(), kUnlimitedMemory);
    joins("");
    EXPECT_EQ(available(), kUnlimitedMemory);
    joins("5:memory:/job\n0::/job\n");
    EXPECT_EQ(available(), kUnlimitedMemory);
}

TEST_F(ControlGroupTest, ReadsVersion1) {
    joins("9:name=systemd:/a\n4:cpu,memory:/job\n2:memory_other:/none\n0::/\n");
    older("", "9223372036854771712", "500", "0");
    older("job", "1000", "700", "200");
    older("none", "3", "2", "0");
    EXPECT_EQ(available(), 500);
}

TEST_F(ControlGroupTest, ReadsVersion2) {
    joins("0::/job\n");
    newer("job", "1000", "700", "200");
    EXPECT_EQ(available(), 500);
    write("sys/fs/cgroup/job/memory.high", "900\n");
    EXPECT_EQ(available(), 400);
    write("sys/fs/cgroup/job/memory.high", "max\n");
    EXPECT_EQ(available(), 500);
}

TEST_F(ControlGroupTest, ReadsVersion2BesideVersion1) {
    joins("4:cpu:/\n0::/job\n");
    newer("unified/job", "1000", "700", "200");
    EXPECT_EQ(available(), 500);
}

TEST_F(ControlGroupTest, TheTightestOfNestedGroupsCounts) {
    joins("0::/slice/service/step\n");
    newer("slice", "5000", "4900", "0");
    newer("slice/service", "2000", "1000", "0");
    newer("slice/service/step", "max", "800", "0");
    newer("slice/other", "1", "1", "0");
    EXPECT_EQ(available(), 100);
    newer("slice", "5000", "1000", "0");
    EXPECT_EQ(available(), 1000);
    newer("slice/service/step", "900", "800", "0");
    EXPECT_EQ(available(), 100);

    joins("7:memory:/slice/service\n");
    older("slice", "300", "200", "0");
    older("slice/service", "9223372036854771712", "0", "0");
    EXPECT_EQ(available(), 100);
}

TEST_F(ControlGroupTest, InAContainerTheTopIsItsGroup) {
    joins("4:memory:/docker/abc\n");
    older("", "1000", "100", "0");
    EXPECT_EQ(available(), 900);
    joins("4:memory:/../../abc\n");
    EXPECT_EQ(available(), 900);
}

TEST_F(ControlGroupTest, MaxIsNoLimit) {
    joins("0::/job\n");
    newer("job", "max", "700", "200");
    EXPECT_EQ(available(), kUnlimitedMemory);
}

TEST_F(ControlGroupTest, NothingIsLeftRatherThanLess) {
    joins("0::/job\n");
    newer("job", "1000", "1700", "200");
    EXPECT_EQ(available(), 0);
    // More of the cache may be inactive than is counted as used, which is summed up later.
    newer("job", "1000", "100", "200");
    EXPECT_EQ(available(), 1000);
}

TEST_F(ControlGroupTest, MissingFilesAreTakenForNothing) {
    joins("0::/job\n");
    write("sys/fs/cgroup/job/memory.max", "1000\n");
    EXPECT_EQ(available(), 1000);
    write("sys/fs/cgroup/job/memory.current", "300\n");
    EXPECT_EQ(available(), 700);
    fs::remove(root / "sys/fs/cgroup/job/memory.max");
    EXPECT_EQ(available(), kUnlimitedMemory);
}

TEST_F(ControlGroupTest, GarbageLimitsNothing) {
    for (const char* memberships : {"memory", ":", "::", "0:", "4:memory", "\n\n", "4:memory:"}) {
        joins(memberships);
        EXPECT_EQ(available(), kUnlimitedMemory) << memberships;
    }
    joins("0::/job\n");
    for (const char* limit : {"", "-1", "12 monkeys", "1000x", "99999999999999999999"}) {
        newer("job", limit, "700", "200");
        EXPECT_EQ(available(), kUnlimitedMemory) << limit;
    }
    newer("job", "1000", "much", "some");
    EXPECT_EQ(available(), 1000);
    // A name that leads out of the hierarchy is cut off at its top.
    joins("0::../../outside\n");
    write("outside/memory.max", "1\n");
    EXPECT_EQ(available(), kUnlimitedMemory);
}

}  // namespace
}  // namespace bandvox
