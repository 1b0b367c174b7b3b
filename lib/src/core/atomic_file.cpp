#include "core/leftovers.h"
#include "core/temporary_table.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <system_error>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;  // as Linux follows

// What a file passes on to the one that replaces it. Who runs it, which the bits above say, was
// granted to the older content.
constexpr mode_t kPermissions = 0777;

// Longer extensions are none that a format has.
constexpr std::size_t kLongestExtension = 16;

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
    throw Error(ErrorKind::Runtime, "cannot write " + target.string() + ": " + why);
}

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// True for /proc/self/fd/1 and the like, which look like links to the file that is open.
bool isDescriptor(const fs::path& path) {
    std::error_code ignored;
    return fs::canonical(folderOf(path), ignored).string().starts_with("/proc/");
}

// Waits until what is in an open file or folder is on its disk. False if that failed, errno says
// why; where it cannot be waited for, there is nothing to wait for.
bool bringToDisk(int descriptor) {
    while (::fsync(descriptor) != 0) {
        if (errno == EINTR) continue;
        return errno == EINVAL || errno == EROFS || errno == ENOTSUP;
    }
    return true;
}

// A name that no other process, and no other file of this one, uses.
fs::path temporaryFor(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    const std::string unique = std::to_string(getpid()) + "-" + std::to_string(counter++);
    const std::string extension = target.extension().string();
    return target.parent_path() /
           (temporaryPrefix() + unique + (extension.size() <= kLongestExtension ? extension : ""));
}

// Throws unless a file can be made in the target's folder, as far as that can be told.
void requireFolder(const fs::path& target, const fs::path& replaced) {
    std::error_code ignored;
    const fs::path folder = folderOf(replaced);
    if (fs::is_symlink(fs::symlink_status(replaced, ignored))) fail(target, "too many links");
    if (!fs::exists(folder, ignored)) fail(target, "there is no folder " + folder.string());
    if (!fs::is_directory(folder, ignored)) fail(target, folder.string() + " is not a folder");
}

}  // namespace

fs::path followLinks(fs::path path) {
    std::error_code error;
    for (int i = 0; i < kMostLinks; ++i) {
        if (!fs::is_symlink(fs::symlink_status(path, error)) || isDescriptor(path)) break;
        const fs::path next = fs::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / next;
    }
    return path;
}

AtomicFile::AtomicFile(fs::path target)
    : mTarget(std::move(target)), mReplaced(followLinks(mTarget)) {
    if (mTarget.filename().empty()) fail(mTarget, "the name is that of a folder");
    struct stat status = {};
    const bool exists = ::stat(mReplaced.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) fail(mTarget, "it is a folder");
    if (exists && S_ISBLK(status.st_mode)) fail(mTarget, "it is a block device");
    if (exists && S_ISSOCK(status.st_mode) && !isDescriptor(mReplaced)) {
        fail(mTarget, "it is a socket");
    }
    mInPlace = exists && (!S_ISREG(status.st_mode) || isDescriptor(mReplaced));
    if (mInPlace) {
        if (::faccessat(AT_FDCWD, mReplaced.c_str(), W_OK, AT_EACCESS) != 0) {
            fail(mTarget, std::strerror(errno));
        }
        return;
    }
    if (exists) mMode = status.st_mode & kPermissions;
    requireFolder(mTarget, mReplaced);

    removeLeftovers(folderOf(mReplaced));
    // Only making a file tells whether one can be made. Do it now, before the work.
    create();
    forget();
}

AtomicFile::~AtomicFile() {
    if (!mCommitted) forget();
}

void AtomicFile::create() {
    for (;;) {
        mTemporary = temporaryFor(mReplaced);
        mSlot = noteTemporary(mTemporary.string());
        const mode_t mode = mMode ? *mMode | S_IWUSR : 0666;
        const int descriptor =
            ::open(mTemporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        const int error = errno;
        if (descriptor >= 0 && claimTemporary(descriptor)) {
            mLock = descriptor;
            return;
        }
        dropTemporary(mSlot);
        mTemporary.clear();
        if (descriptor >= 0) {
            ::close(descriptor);
        } else if (error != EEXIST) {
            // A process of the same number may have died and left such a name.
            fail(mTarget, std::strerror(error));
        }
    }
}

void AtomicFile::forget() {
    if (mTemporary.empty()) return;
    ::unlink(mTemporary.c_str());
    dropTemporary(mSlot);
    mTemporary.clear();
    release();
}

void AtomicFile::release() {
    if (mSync.valid()) mSync.wait();
    if (mLock >= 0) ::close(mLock);
    mLock = -1;
}

std::ofstream AtomicFile::open() {
    if (!mInPlace) create();
    // What is in place already, in the file that is the standard output, is not written over.
    std::ofstream stream(mInPlace ? mReplaced : mTemporary,
                         std::ios::binary | (mInPlace ? std::ios::app : std::ios::trunc));
    if (!stream) fail(mTarget, std::strerror(errno));
    return stream;
}

void AtomicFile::beginSync() noexcept {
#ifdef __linux__
    using std::chrono::seconds;
    const bool isBusy = mSync.valid() && mSync.wait_for(seconds(0)) != std::future_status::ready;
    if (mLock < 0 || isBusy) return;
    try {
        // It waits where the disk has enough to do.
        mSync = std::async(std::launch::async, [lock = mLock] {
            ::sync_file_range(lock, 0, 0, SYNC_FILE_RANGE_WRITE);
        });
    } catch (const std::system_error&) {
        // Without another thread there is more to wait for in the end.
    }
#endif
}

void AtomicFile::complete() {
    if (mInPlace || mCompleted) return;
    const int descriptor = ::open(mTemporary.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail(mTarget, std::strerror(errno));
    // Where permissions cannot be passed on, the file keeps those that it was made with.
    if (mMode) ::fchmod(descriptor, *mMode);
    // A name can reach the disk before what it names does, and the power can fail in between.
    const bool done = bringToDisk(descriptor);
    const int error = errno;
    ::close(descriptor);
    if (!done) fail(mTarget, std::strerror(error));
    mCompleted = true;
}

void AtomicFile::commit() {
    if (!mInPlace) {
        complete();
        std::error_code error;
        fs::rename(mTemporary, mReplaced, error);
        if (error) fail(mTarget, error.message());
        dropTemporary(mSlot);
        release();
        // The file is whole under either name; so that the new one lasts is only tried.
        const int folder = ::open(folderOf(mReplaced).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder >= 0) {
            bringToDisk(folder);
            ::close(folder);
        }
    }
    mCommitted = true;
}

void AtomicFile::removeTemporaries() noexcept {
    removeNotedTemporaries();
}

}  // namespace bandvox
