#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <optional>

namespace bandvox {

/// What writing to `path` creates or replaces: links are followed, also one that leads to nothing
/// yet. Links to the process's own descriptors, as /dev/stdout, stay what they are.
std::filesystem::path followLinks(std::filesystem::path path);

/// An output file that appears whole or not at all: it is written under a temporary name in the
/// folder of its target, and takes the target's name when it is committed and on the disk.
///
/// Links are followed. A file that is replaced passes its permissions on, except for those to run
/// as somebody else. What cannot be replaced
/// is written in place: a character device, a pipe, one of the process's own descriptors.
///
/// A process that is killed leaves its temporary file, ".bandvox-..." with the target's extension.
/// The next file that is written to that folder, by the same user on the same machine since it was
/// started, removes it; what other machines have left is left to whoever knows of them.
class AtomicFile {
  public:
    /// Makes sure that the target can be written, and leaves nothing behind. Throws
    /// Error(ErrorKind::Runtime) if its folder is missing or cannot be written to, or if it is a
    /// folder, a block device or a socket.
    explicit AtomicFile(std::filesystem::path target);
    /// Removes the temporary file unless it was committed.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The name that was asked for.
    const std::filesystem::path& target() const { return mTarget; }

    /// True if the target itself is written to, from its start to its end without going back.
    bool inPlace() const { return mInPlace; }

    /// Creates the temporary file, and opens it. Called once; a process that dies before that
    /// leaves nothing. Throws Error(ErrorKind::Runtime) if that fails.
    std::ofstream open();

    /// Where open() has made the file: it has a short name of its own, with the target's
    /// extension. Empty before that, and if the target is written in place.
    const std::filesystem::path& temporary() const { return mTemporary; }

    /// Begins to bring to the disk what was written so far, and does not wait for it: there will be
    /// less for complete() to wait for.
    void beginSync() noexcept;

    /// Waits until the written file is on the disk, so that committing it hardly can fail. To be
    /// called, if at all, after the last write. Throws Error(ErrorKind::Runtime) if that fails.
    void complete();

    /// Completes the written file and gives it the target's name, replacing what was there. Throws
    /// Error(ErrorKind::Runtime) if that fails.
    void commit();

    /// Removes the temporary files of this process that are not committed. For a handler of a
    /// signal that ends the process: async-signal-safe.
    static void removeTemporaries() noexcept;

  private:
    void create();
    void forget();
    void release();

    std::filesystem::path mTarget;
    std::filesystem::path mReplaced;  // the target, or what it links to
    std::filesystem::path mTemporary;
    bool mInPlace = false;
    std::optional<mode_t> mMode;  // of the file that is replaced
    int mSlot = -1;               // in the table of temporaries
    int mLock = -1;               // descriptor that keeps others from removing the temporary
    std::future<void> mSync;      // what beginSync has begun
    bool mCompleted = false;
    bool mCommitted = false;
};

}  // namespace bandvox
