#pragma once

#include <cstddef>
#include <filesystem>
#include <ios>
#include <span>
#include <streambuf>
#include <string>
#include <vector>

namespace bandvox {

/// Bytes that can be read from any place, by many threads at once.
class ByteSource {
  public:
    virtual ~ByteSource() = default;

    /// How many there are.
    std::streamoff size() const { return mSize; }

    /// Reads `to.size()` bytes from `place` on, or as many as there are. Returns their number.
    virtual std::size_t read(std::streamoff place, std::span<char> to) const = 0;

  protected:
    explicit ByteSource(std::streamoff size) : mSize(size) {}

  private:
    std::streamoff mSize;
};

/// A regular file. One that becomes shorter while it is read ends there.
class FileBytes final : public ByteSource {
  public:
    /// Opens the file; isOpen() tells whether that succeeded.
    FileBytes(const std::filesystem::path& path, std::streamoff size);
    ~FileBytes() override;
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    bool isOpen() const { return mDescriptor >= 0; }
    std::size_t read(std::streamoff place, std::span<char> to) const override;

  private:
    int mDescriptor;
};

/// Bytes in memory.
class MemoryBytes final : public ByteSource {
  public:
    explicit MemoryBytes(std::string bytes);
    std::size_t read(std::streamoff place, std::span<char> to) const override;

  private:
    std::string mBytes;
};

/// A stream's buffer for reading that stretch of a source from `begin` up to `end`; its places
/// count from `begin`. What lies within the part that is in memory is skipped without reading.
class SourceBuffer : public std::streambuf {
  public:
    SourceBuffer(const ByteSource& source, std::streamoff begin, std::streamoff end);

    const ByteSource& source() const { return mSource; }

  protected:
    int_type underflow() override;
    std::streamsize xsgetn(char* to, std::streamsize count) override;
    std::streampos seekoff(std::streamoff offset, std::ios::seekdir from,
                           std::ios::openmode which) override;
    std::streampos seekpos(std::streampos place, std::ios::openmode which) override;

  private:
    // Of the source.
    std::streamoff place() const { return mPartEnd - (egptr() - gptr()); }

    const ByteSource& mSource;
    std::streamoff mBegin, mEnd;
    std::vector<char> mPart;
    std::streamoff mPartEnd;  // of what is in memory
};

}  // namespace bandvox
