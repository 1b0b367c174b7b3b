#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// What a picture shows beyond its edges: itself again, its mirror image, or its last texels.
enum class TextureWrap { Repeat, Mirror, Clamp };

/// How texture coordinates outside of [0, 1] are taken.
struct TextureWraps {
    TextureWrap u = TextureWrap::Repeat;
    TextureWrap v = TextureWrap::Repeat;
};

/// A picture in linear light, and smaller and smaller copies of it, down to one texel: each texel
/// of a copy is the mean of what it covers. Immutable once built; many threads may read it.
class Texture {
  public:
    /// `rgb`: linear light, 65535 is 1; three numbers a texel, rows from the top.
    Texture(int width, int height, std::vector<std::uint16_t> rgb);

    /// Bytes that one of so many texels takes.
    static double memory(double width, double height) { return width * height * 3 * 2 * 4 / 3; }

    int width() const { return mLevels[0].width; }
    int height() const { return mLevels[0].height; }
    int levels() const { return static_cast<int>(mLevels.size()); }

    /// The colour at (u, v) in `level`, 0 to levels() - 1, interpolated bilinearly between the
    /// centres of texels. (0, 0) is the lower left corner of the picture, (1, 1) the upper right.
    openvdb::Vec3f sample(const openvdb::Vec2d& at, const TextureWraps& wraps, int level) const;

  private:
    struct Level {
        int width, height;
        std::vector<std::uint16_t> rgb;
    };

    static Level halved(const Level& level);

    std::vector<Level> mLevels;
};

}  // namespace bandvox
