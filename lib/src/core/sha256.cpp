#include "core/sha256_blocks.h"

#include <bandvox/core/error.h>
#include <bandvox/core/sha256.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace bandvox {

namespace {

constexpr std::size_t kReadBytes = 1 << 20;

}  // namespace

void Sha256::add(std::string_view bytes) {
    mBytes += bytes.size();
    while (!bytes.empty()) {
        const std::size_t blocks = bytes.size() / kSha256BlockBytes;
        if (mFilled == 0 && blocks > 0) {
            addSha256Blocks(mState, reinterpret_cast<const unsigned char*>(bytes.data()), blocks);
            bytes.remove_prefix(blocks * kSha256BlockBytes);
            continue;
        }
        const std::size_t taken = std::min(bytes.size(), kSha256BlockBytes - mFilled);
        std::memcpy(mBlock.data() + mFilled, bytes.data(), taken);
        bytes.remove_prefix(taken);
        mFilled += taken;
        if (mFilled < kSha256BlockBytes) continue;
        addSha256Blocks(mState, mBlock.data(), 1);
        mFilled = 0;
    }
}

std::string Sha256::finish() {
    // A one, zeros, and how many bits there were: section 5.1.1.
    const std::uint64_t bits = 8 * mBytes;
    add(std::string_view("\x80", 1));
    while (mFilled != kSha256BlockBytes - 8) add(std::string_view("\0", 1));
    std::array<char, 8> length{};
    for (std::size_t i = 0; i < length.size(); ++i) {
        length[i] = static_cast<char>(bits >> (56 - 8 * i) & 0xff);
    }
    add(std::string_view(length.data(), length.size()));
    std::string digits;
    for (const std::uint32_t word : mState) {
        for (int shift = 28; shift >= 0; shift -= 4) {
            digits += "0123456789abcdef"[word >> shift & 0xf];
        }
    }
    return digits;
}

std::string sha256(std::string_view bytes) {
    Sha256 digest;
    digest.add(bytes);
    return digest.finish();
}

std::string sha256OfFile(const std::filesystem::path& path, Progress& progress) {
    const auto fail = [&](int error) {
        return Error(ErrorKind::Input,
                     "cannot read " + path.string() + ": " + std::strerror(error));
    };
    std::ifstream file(path, std::ios::binary);
    if (!file) throw fail(errno);
    Sha256 digest;
    std::string buffer(kReadBytes, '\0');
    while (file) {
        progress.throwIfInterrupted();
        errno = 0;
        file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        if (file.bad()) throw fail(errno);
        digest.add(std::string_view(buffer.data(), static_cast<std::size_t>(file.gcount())));
    }
    return digest.finish();
}

}  // namespace bandvox
