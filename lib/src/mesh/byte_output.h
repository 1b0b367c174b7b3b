#pragma once

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/progress.h>

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace bandvox {

/// Writes a file from start to end, through a buffer.
class ByteOutput {
  public:
    /// Opens the file. Throws as AtomicFile::open.
    ByteOutput(AtomicFile& file, Progress& progress);

    /// Throws Error(ErrorKind::Runtime) if the disk is full or fails,
    /// Error(ErrorKind::Interrupted).
    void put(std::string_view bytes) {
        mBuffer.append(bytes);
        if (mBuffer.size() >= kBufferBytes) flush();
    }

    void put(char byte) { put(std::string_view(&byte, 1)); }

    /// Four bytes, least first.
    void put(std::uint32_t number) {
        const char bytes[] = {static_cast<char>(number), static_cast<char>(number >> 8),
                              static_cast<char>(number >> 16), static_cast<char>(number >> 24)};
        put(std::string_view(bytes, sizeof bytes));
    }
    void put(float number) { put(std::bit_cast<std::uint32_t>(number)); }
    void put(double number) {
        const auto bits = std::bit_cast<std::uint64_t>(number);
        put(static_cast<std::uint32_t>(bits));
        put(static_cast<std::uint32_t>(bits >> 32));
    }

    /// The shortest text that reads back as the number.
    template <typename Number>
    void putText(Number number) {
        char text[32];
        const auto end = std::to_chars(text, text + sizeof text, number).ptr;
        put(std::string_view(text, static_cast<std::size_t>(end - text)));
    }

    /// Writes what is left, and closes the file. Throws as put.
    void close();

    /// CRC-32 of all that was written so far; of the whole file once it is closed.
    std::uint32_t checksum() const { return mChecksum; }

  private:
    static constexpr std::size_t kBufferBytes = 1 << 20;

    void flush();
    [[noreturn]] void fail() const;

    AtomicFile& mFile;
    Progress& mProgress;
    std::ofstream mStream;
    std::string mBuffer;
    std::uint32_t mChecksum = 0;
};

/// Turns bytes into base 64 on their way, as RFC 4648 has it.
class Base64Output {
  public:
    explicit Base64Output(ByteOutput& output) : mOutput(output) {}

    void put(std::uint32_t number);
    void put(float number) { put(std::bit_cast<std::uint32_t>(number)); }

    /// Writes what is left, and padding.
    void close();

  private:
    void putByte(unsigned byte);

    ByteOutput& mOutput;
    std::uint32_t mBits = 0;
    int mBytes = 0;  // in mBits
};

}  // namespace bandvox
