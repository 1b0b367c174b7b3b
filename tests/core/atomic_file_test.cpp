#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <thread>

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
    static void fill(AtomicFile& file, const std::string& text) { file.open() << text; }
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
    fill(file, "new");
    EXPECT_EQ(file.temporary().extension(), ".vdb");
    EXPECT_EQ(file.temporary().parent_path(), folder);
    EXPECT_EQ(read(folder / "a.vdb"), "old");
    file.commit();
    EXPECT_EQ(read(folder / "a.vdb"), "new");
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, WithoutCommitNothingIsLeft) {
    write(folder / "a.vdb", "old");
    {
        AtomicFile file(folder / "a.vdb");
        fill(file, "half");
        EXPECT_EQ(countFiles(), 2);
    }
    EXPECT_EQ(read(folder / "a.vdb"), "old");
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, MakesNothingBeforeItIsOpened) {
    const AtomicFile file(folder / "a.vdb");
    EXPECT_EQ(countFiles(), 0);
}

TEST_F(AtomicFileTest, TwoFilesOfOneTargetDoNotMeet) {
    AtomicFile a(folder / "a.vdb");
    AtomicFile b(folder / "a.vdb");
    fill(a, "a");
    fill(b, "b");
    EXPECT_NE(a.temporary(), b.temporary());
    EXPECT_EQ(read(a.temporary()), "a");
}

TEST_F(AtomicFileTest, TakesTheLongestNames) {
    std::string name(251, 'n');
    name += ".vdb";
    const fs::path target = folder / name;
    AtomicFile file(target);
    fill(file, "long");
    file.commit();
    EXPECT_EQ(read(target), "long");
}

TEST_F(AtomicFileTest, WritesWhatALinkLeadsTo) {
    fs::create_directory(folder / "far");
    write(folder / "far" / "a.vdb", "old");
    fs::create_symlink("far/a.vdb", folder / "link.vdb");
    fs::create_symlink("far/b.vdb", folder / "dangling.vdb");
    for (const char* name : {"link.vdb", "dangling.vdb"}) {
        AtomicFile file(folder / name);
        fill(file, name);
        EXPECT_EQ(file.temporary().parent_path(), folder / "far");
        file.commit();
        EXPECT_TRUE(fs::is_symlink(folder / name));
    }
    EXPECT_EQ(read(folder / "far" / "a.vdb"), "link.vdb");
    EXPECT_EQ(read(folder / "far" / "b.vdb"), "dangling.vdb");
    fs::create_symlink("ring.vdb", folder / "ring.vdb");
    EXPECT_THROW(AtomicFile(folder / "ring.vdb"), Error);
}

TEST_F(AtomicFileTest, KeepsTheModeOfWhatItReplaces) {
    for (const auto mode : {fs::perms(0600), fs::perms(0444), fs::perms(0755)}) {
        write(folder / "a.vdb", "old");
        fs::permissions(folder / "a.vdb", mode);
        AtomicFile file(folder / "a.vdb");
        fill(file, "new");
        file.commit();
        EXPECT_EQ(fs::status(folder / "a.vdb").permissions(), mode);
        fs::remove(folder / "a.vdb");
    }
}

TEST_F(AtomicFileTest, PassesNoSetUserIdOn) {
    write(folder / "a.vdb", "old");
    fs::permissions(folder / "a.vdb", fs::perms(07755));
    AtomicFile file(folder / "a.vdb");
    fill(file, "new");
    file.commit();
    EXPECT_EQ(fs::status(folder / "a.vdb").permissions(), fs::perms(0755));
}

TEST_F(AtomicFileTest, GoesOnWhileItIsBroughtToTheDisk) {
    AtomicFile file(folder / "a");
    file.beginSync();  // there is nothing yet
    std::string whole;
    {
        std::ofstream stream = file.open();
        for (int part = 0; part < 64; ++part) {
            const std::string text(100000, static_cast<char>('0' + part % 10));
            stream << text << std::flush;
            file.beginSync();
            whole += text;
        }
    }
    file.commit();
    EXPECT_EQ(read(folder / "a"), whole);
    EXPECT_EQ(countFiles(), 1);
    // One that is given up while it is.
    {
        AtomicFile other(folder / "b");
        other.open() << whole << std::flush;
        other.beginSync();
    }
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, CompletedFileHasNotItsNameYet) {
    write(folder / "a.vdb", "old");
    AtomicFile file(folder / "a.vdb");
    fill(file, "new");
    file.complete();
    file.complete();
    EXPECT_EQ(read(folder / "a.vdb"), "old");
    EXPECT_EQ(read(file.temporary()), "new");
    file.commit();
    EXPECT_EQ(read(folder / "a.vdb"), "new");
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, FailsIfTheTargetHasBecomeAFolder) {
    {
        AtomicFile file(folder / "a.vdb");
        fill(file, "new");
        fs::create_directory(folder / "a.vdb");
        EXPECT_THROW(file.commit(), Error);
    }
    EXPECT_EQ(countFiles(), 1);
}

TEST_F(AtomicFileTest, FailsIfWhatWasWrittenIsGone) {
    AtomicFile file(folder / "a.vdb");
    fill(file, "new");
    fs::remove(file.temporary());
    EXPECT_THROW(file.complete(), Error);
    EXPECT_EQ(countFiles(), 0);
}

TEST_F(AtomicFileTest, WritesDevicesAndPipesInPlace) {
    fs::create_symlink("/dev/null", folder / "null.vdb");
    AtomicFile null(folder / "null.vdb");
    EXPECT_TRUE(null.inPlace());
    fill(null, "gone");
    null.commit();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_TRUE(fs::is_symlink(folder / "null.vdb"));

    ASSERT_EQ(mkfifo((folder / "pipe.vdb").c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = read(folder / "pipe.vdb"); });
    {
        AtomicFile pipe(folder / "pipe.vdb");
        EXPECT_TRUE(pipe.inPlace());
        fill(pipe, "sent");
        pipe.commit();
    }
    reader.join();
    EXPECT_EQ(received, "sent");
    EXPECT_TRUE(fs::is_fifo(folder / "pipe.vdb"));
}

TEST_F(AtomicFileTest, RemovesTemporariesForAHandlerOfSignals) {
    AtomicFile a(folder / "a.vdb");
    AtomicFile b(folder / "b.vdb");
    fill(a, "half");
    fill(b, "whole");
    b.commit();
    AtomicFile::removeTemporaries();
    EXPECT_EQ(countFiles(), 1);
    EXPECT_EQ(read(folder / "b.vdb"), "whole");
}

// A name that a process which was killed would leave, in the way of those that live.
fs::path leftover(const fs::path& folder, const std::string& process) {
    AtomicFile file(folder / "name.vdb");
    file.open();
    std::string name = file.temporary().filename().string();
    const std::string own = std::to_string(getpid());
    return folder / name.replace(name.find(own), own.size(), process);
}

TEST_F(AtomicFileTest, RemovesWhatKilledProcessesHaveLeft) {
    const fs::path left = leftover(folder, "1234567-0");
    const fs::path sub = folder / "sub";
    fs::create_directory(sub);
    write(sub / left.filename(), "half");
    // Of other machines, or of something else altogether.
    write(sub / ".bandvox-0123abcd-1-0.vdb", "half");
    write(sub / "name.vdb", "older");
    fs::create_directory(sub / (left.filename().string() + "-folder"));
    const AtomicFile file(sub / "other.vdb");
    EXPECT_FALSE(fs::exists(sub / left.filename()));
    EXPECT_TRUE(fs::exists(sub / ".bandvox-0123abcd-1-0.vdb"));
    EXPECT_TRUE(fs::exists(sub / "name.vdb"));
    EXPECT_TRUE(fs::exists(sub / (left.filename().string() + "-folder")));
}

TEST_F(AtomicFileTest, LeavesFilesAloneThatSomebodyWrites) {
    const fs::path sub = folder / "sub";
    fs::create_directory(sub);
    int ready[2], done[2];
    ASSERT_EQ(pipe(ready), 0);
    ASSERT_EQ(pipe(done), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        // The other process: writes half, waits, and writes the rest.
        AtomicFile file(sub / "a.vdb");
        std::ofstream stream = file.open();
        stream << "half" << std::flush;
        char byte = 0;
        const bool went = ::write(ready[1], "r", 1) == 1 && ::read(done[0], &byte, 1) == 1;
        stream << " and half" << std::flush;
        if (went) file.commit();
        ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    {
        AtomicFile file(sub / "b.vdb");
        fill(file, "b");
        file.commit();
    }
    ASSERT_EQ(::write(done[1], "d", 1), 1);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(read(sub / "a.vdb"), "half and half");
    EXPECT_EQ(read(sub / "b.vdb"), "b");
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
