#pragma once

#include <openvdb/Types.h>

#include <cstdint>

namespace bandvox {

/// Numbers in [0, 1) for one line of sight: those of the lines of sight of a pixel are spread more
/// evenly than chance would. They depend on the seed, the pixel, and the sample's number alone.
///
/// The Sobol' sequence, scrambled after A. Owen as in B. Burley: "Practical Hash-based Owen
/// Scrambling" (2020), whose pairs of dimensions are shuffled against each other.
class SampleStream {
  public:
    SampleStream(std::uint32_t seed, std::uint32_t column, std::uint32_t row, std::uint32_t sample)
        : mPixel(mix(mix(mix(seed) ^ column) ^ row)), mSample(sample) {}

    /// The next place in the unit square.
    openvdb::Vec2d next2() {
        const std::uint32_t pair = mix(mPixel ^ (0x9E3779B9u * ++mPairs));
        const std::uint32_t index = scramble(mSample, pair);
        return {toUnit(scramble(reversed(index), mix(pair ^ 1))),
                toUnit(scramble(sobolSecond(index), mix(pair ^ 2)))};
    }

    double next() { return next2()[0]; }

    /// A stream that is independent of this one, for a branch of the path.
    SampleStream branch(std::uint32_t number) const {
        SampleStream other = *this;
        other.mPixel = mix(mPixel ^ mix(number + 0x51ED270Bu * (mPairs + 1)));
        other.mPairs = 0;
        return other;
    }

  private:
    static std::uint32_t mix(std::uint32_t x) {
        x ^= x >> 16;
        x *= 0x7FEB352Du;
        x ^= x >> 15;
        x *= 0x846CA68Bu;
        x ^= x >> 16;
        return x;
    }

    static std::uint32_t reversed(std::uint32_t x) {
        x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
        x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
        x = ((x >> 4) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4);
        x = ((x >> 8) & 0x00FF00FFu) | ((x & 0x00FF00FFu) << 8);
        return (x >> 16) | (x << 16);
    }

    // Permutes the halves of every dyadic interval, by the hash of S. Laine and T. Karras.
    static std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
        x = reversed(x);
        x ^= x * 0x3D20ADEAu;
        x += seed;
        x *= (seed >> 16) | 1;
        x ^= x * 0x05526C56u;
        x ^= x * 0x53A22864u;
        return reversed(x);
    }

    // The second dimension of the Sobol' sequence, whose matrix is Pascal's triangle modulo 2.
    static std::uint32_t sobolSecond(std::uint32_t index) {
        std::uint32_t result = 0;
        for (std::uint32_t column = 0x80000000u; index != 0; index >>= 1) {
            if ((index & 1) != 0) result ^= column;
            column ^= column >> 1;
        }
        return result;
    }

    static double toUnit(std::uint32_t x) { return x * 0x1p-32; }

    std::uint32_t mPixel;
    std::uint32_t mSample;
    std::uint32_t mPairs = 0;
};

}  // namespace bandvox
