#include "mesh/byte_output.h"

#include "mesh/mesh_checksum.h"

#include <bandvox/core/error.h>

#include <cerrno>
#include <cstring>

namespace bandvox {

namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

ByteOutput::ByteOutput(AtomicFile& file, Progress& progress)
    : mFile(file), mProgress(progress), mStream(file.open()) {
    mBuffer.reserve(kBufferBytes + 4096);
}

void ByteOutput::fail() const {
    throw Error(ErrorKind::Runtime, "cannot write " + mFile.target().string() + ": " +
                                        (errno != 0 ? std::strerror(errno) : "unknown failure"));
}

void ByteOutput::flush() {
    mProgress.throwIfInterrupted();
    mChecksum = checksumOf(mBuffer, mChecksum);
    errno = 0;
    mStream.write(mBuffer.data(), static_cast<std::streamsize>(mBuffer.size()));
    if (!mStream) fail();
    mBuffer.clear();
}

void ByteOutput::close() {
    flush();
    errno = 0;
    mStream.close();
    if (!mStream) fail();
}

void Base64Output::put(std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) putByte(number >> shift & 0xFF);
}

void Base64Output::putByte(unsigned byte) {
    mBits = mBits << 8 | byte;
    if (++mBytes < 3) return;
    const char text[] = {kDigits[mBits >> 18 & 63], kDigits[mBits >> 12 & 63],
                         kDigits[mBits >> 6 & 63], kDigits[mBits & 63]};
    mOutput.put(std::string_view(text, sizeof text));
    mBits = 0;
    mBytes = 0;
}

void Base64Output::close() {
    const int missing = (3 - mBytes) % 3;
    if (missing == 0) return;
    // Zeros up to the next three bytes; of their digits none stands for zeros alone.
    std::string digits;
    const std::uint32_t bits = mBits << 8 * missing;
    for (int k = 0; k <= mBytes; ++k) digits += kDigits[bits >> (18 - 6 * k) & 63];
    digits.append(static_cast<std::size_t>(missing), '=');
    mOutput.put(digits);
    mBits = 0;
    mBytes = 0;
}

}  // namespace bandvox
