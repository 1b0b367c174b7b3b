#pragma once

#include <filesystem>

namespace bandvox {

/// An output file that appears whole or not at all: it is written under a temporary name in the
/// target's folder, and takes the target's name when it is committed.
///
/// The temporary name keeps the target's extension, because writers choose a format by it.
class AtomicFile {
  public:
    /// Throws Error(ErrorKind::Runtime) if the target's folder is missing or cannot be written
    /// to, or if the target is a folder.
    explicit AtomicFile(std::filesystem::path target);
    /// Removes the temporary file unless it was committed.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write.
    const std::filesystem::path& temporary() const { return mTemporary; }

    /// Gives the written file the target's name, replacing what was there. Throws
    /// Error(ErrorKind::Runtime) if that fails.
    void commit();

  private:
    std::filesystem::path mTarget;
    std::filesystem::path mTemporary;
    bool mCommitted = false;
};

}  // namespace bandvox
