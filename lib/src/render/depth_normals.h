#pragma once

#include <bandvox/render/camera.h>

#include <openvdb/Types.h>

#include <optional>
#include <span>

namespace bandvox {

/// How far lines of sight went, one for each pixel, all through the same place in it.
struct DistanceBuffer {
    int width, height;                 ///< pixels
    openvdb::Vec2d place;              ///< in the pixel, [0, 1)²
    std::span<const double> distance;  ///< [height][width] world; infinite where nothing was met
};

/// Normals of what a distance buffer shows, from differences of neighbours' positions in the
/// world, so that perspective does not matter.
///
/// The differences are those between the pixels on both sides. Where one of these sees nothing,
/// the pixel between stands for it. A row of which two pixels see nothing does not count; if none
/// counts, the surface is taken to lie across the view.
class DepthNormals {
  public:
    /// How much the rows beside and the pixel's own count: 0, 1 is the cross of four neighbours
    /// (Chen, Herman et al., 1985), 1, 2 Sobel's operator (Lenz et al., 1986).
    struct Weights {
        int beside, own;
    };
    static constexpr Weights kCross{0, 1}, kSobel{1, 2};

    DepthNormals(const Camera& camera, const DistanceBuffer& buffer, Weights weights)
        : mCamera(camera), mBuffer(buffer), mWeights(weights) {}

    /// The normal at a pixel that sees something, world, unit, towards the eye.
    openvdb::Vec3d at(int column, int row) const;

  private:
    struct Pixel {
        int column, row;
        Pixel operator+(const Pixel& o) const { return {column + o.column, row + o.row}; }
        Pixel operator-(const Pixel& o) const { return {column - o.column, row - o.row}; }
    };
    std::optional<openvdb::Vec3d> position(const Pixel& pixel) const;
    std::optional<openvdb::Vec3d> difference(const Pixel& middle, const Pixel& step) const;
    std::optional<openvdb::Vec3d> slope(const Pixel& middle, const Pixel& step) const;

    const Camera& mCamera;
    const DistanceBuffer& mBuffer;
    Weights mWeights;
};

}  // namespace bandvox
