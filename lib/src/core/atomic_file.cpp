#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
    throw Error(ErrorKind::Runtime, "cannot write " + target.string() + ": " + why);
}

// A name that no other process, and no other file of this one, uses.
fs::path temporaryFor(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    const std::string unique = std::to_string(getpid()) + "-" + std::to_string(counter++);
    return target.parent_path() /
           ("." + target.stem().string() + ".tmp-" + unique + target.extension().string());
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : mTarget(std::move(target)) {
    std::error_code ignored;
    const fs::path folder = mTarget.has_parent_path() ? mTarget.parent_path() : fs::path(".");
    if (mTarget.filename().empty()) fail(mTarget, "the name is that of a folder");
    if (fs::is_directory(mTarget, ignored)) fail(mTarget, "it is a folder");
    if (!fs::exists(folder, ignored)) fail(mTarget, "there is no folder " + folder.string());
    if (!fs::is_directory(folder, ignored)) fail(mTarget, folder.string() + " is not a folder");

    // Create the file now, so that a folder that cannot be written to is known before the work.
    mTemporary = temporaryFor(mTarget);
    const int descriptor =
        ::open(mTemporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) fail(mTarget, std::strerror(errno));
    ::close(descriptor);
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!mCommitted) fs::remove(mTemporary, ignored);
}

void AtomicFile::commit() {
    std::error_code error;
    fs::rename(mTemporary, mTarget, error);
    if (error) fail(mTarget, error.message());
    mCommitted = true;
}

}  // namespace bandvox
