#include <bandvox/core/error.h>
#include <bandvox/core/sha256.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace bandvox {

namespace {

// The standard's K: the first 32 bits of the fractional parts of the cube roots of the first 64
// primes.
constexpr std::array<std::uint32_t, 64> kRoundConstants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

constexpr std::size_t kBlockBytes = 64;
constexpr std::size_t kReadBytes = 1 << 20;

std::uint32_t bigEndian(const unsigned char* bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
           std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]};
}

}  // namespace

// Section 6.2.2 of the standard.
void Sha256::addBlock(const unsigned char* block) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t t = 0; t < 16; ++t) w[t] = bigEndian(block + 4 * t);
    for (std::size_t t = 16; t < 64; ++t) {
        const std::uint32_t s0 =
            std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
        const std::uint32_t s1 =
            std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
        w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = mState;
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const std::uint32_t choice = (e & f) ^ (~e & g);
        const std::uint32_t t1 = h + sum1 + choice + kRoundConstants[t] + w[t];
        const std::uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const std::uint32_t majority = (a & b) ^ (a & c) ^ (b & c);
        h = g;
        g = f;
        f = e;
        e = d + t1;
        d = c;
        c = b;
        b = a;
        a = t1 + sum0 + majority;
    }
    const std::array<std::uint32_t, 8> added{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < added.size(); ++i) mState[i] += added[i];
}

void Sha256::add(std::string_view bytes) {
    mBytes += bytes.size();
    while (!bytes.empty()) {
        if (mFilled == 0 && bytes.size() >= kBlockBytes) {
            addBlock(reinterpret_cast<const unsigned char*>(bytes.data()));
            bytes.remove_prefix(kBlockBytes);
            continue;
        }
        const std::size_t taken = std::min(bytes.size(), kBlockBytes - mFilled);
        std::memcpy(mBlock.data() + mFilled, bytes.data(), taken);
        bytes.remove_prefix(taken);
        mFilled += taken;
        if (mFilled < kBlockBytes) continue;
        addBlock(mBlock.data());
        mFilled = 0;
    }
}

std::string Sha256::finish() {
    // A one, zeros, and how many bits there were: section 5.1.1.
    const std::uint64_t bits = 8 * mBytes;
    add(std::string_view("\x80", 1));
    while (mFilled != kBlockBytes - 8) add(std::string_view("\0", 1));
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
