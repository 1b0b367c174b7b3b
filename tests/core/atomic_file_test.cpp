#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) /
                 ("bandvox_atomic_" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder);
        fs::create_directory(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    static void write(const fs::path& path, const std::string& text) {
        std::ofstream(path) << text;
    }
    static std::string read(const fs::path& path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    long countFiles() const {
        return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    }

    fs::path folder;
};

TEST_F(AtomicFileTest, CommitGivesTheTargetItsContent) {
    write(folder / "a.vdb", "old");
    AtomicFile file(folder / "a.vdb");
    EXPECT_EQ(file.temporary().extension(), ".vdb");
    EXPECT_EQ(file.temporary().parent_path(), folder);
    write(file.temporary(), "new");
    EXPECT_EQ(read(folder / "a.vdb"), "old");
    file.commit();
    EXPECT_EQ(read(folder / "a.vdb"), "new");
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitNothingIsLeft) {
    write(folder / "a.vdb", "old");
    {
        const AtomicFile file(folder / "a.vdb");
        write(file.temporary(), "half");
        EXPECT_EQ(countFiles(), 2);
    }
    EXPECT_EQ(read(folder / "a.vdb"), "old");
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, TwoFilesOfOneTargetDoNotMeet) {
    const AtomicFile a(folder / "a.vdb");
    const AtomicFile b(folder / "a.vdb");
    EXPECT_NE(a.temporary(), b.temporary());
}

TEST_F(AtomicFileTest, RefusesTargetsThatCannotBe) {
    write(folder / "file", "");
    for (const fs::path& target : {folder, folder / "missing" / "a.vdb", folder / "file" / "a.vdb",
                                   fs::path("/proc/a.vdb")}) {
        try {
            const AtomicFile file(target);
            FAIL() << target;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Runtime);
            EXPECT_NE(std::string(error.what()).find(target.string()), std::string::npos);
        }
    }
    EXPECT_EQ(countFiles(), 1);
}

}  // namespace
}  // namespace bandvox
