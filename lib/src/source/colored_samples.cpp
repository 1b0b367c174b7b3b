#include "source/colored_samples.h"

#include "source/triangle_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bandvox {
namespace {

using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3f;

/// Longest edges, in voxels, of a part of a textured triangle for the first rules. Those that are
/// chosen for the lattice know its waves; a texture has texels, and points have to be closer. Where
/// texels are farther apart than kFarTexels voxels, three points are enough.
constexpr std::array<double, 3> kTexturedEdges = {0.25, 0.6, 1};
constexpr double kFarTexels = 1.5;

/// A corner of a part of a triangle: its place, and its barycentric coordinates on the whole.
struct BarycentricCorner {
    Vec3d place, weights;
};

const Vec3d& placeOf(const BarycentricCorner& corner) {
    return corner.place;
}
BarycentricCorner middleOf(const BarycentricCorner& a, const BarycentricCorner& b) {
    return {0.5 * (a.place + b.place), 0.5 * (a.weights + b.weights)};
}

/// The colours on one triangle.
class PaintSampler {
  public:
    /// `area` of the triangle in voxels².
    PaintSampler(const ColoredMesh& mesh, const TrianglePaint& paint, double area) : mPaint(paint) {
        if (paint.texture < 0) return;
        mTexture = &mesh.textures[paint.texture];
        const Vec2d a(paint.uv[0]), b(paint.uv[1]), c(paint.uv[2]);
        const Vec2d e1 = b - a;
        const Vec2d e2 = c - a;
        const Texture& picture = *mTexture->picture;
        mTexelsPerArea = 0.5 * std::abs(e1.x() * e2.y() - e1.y() * e2.x()) * picture.width() *
                         picture.height() / area;
    }

    bool isTextured() const { return mTexture != nullptr; }
    double texelsPerArea() const { return mTexelsPerArea; }  ///< per voxel²

    /// The texture's level for points that stand for so much area each, voxels².
    int levelFor(double areaOfPoint) const {
        if (!isTextured()) return 0;
        const double texels = mTexelsPerArea * areaOfPoint;
        if (!(texels > 1)) return 0;
        const double level = std::ceil(0.5 * std::log2(texels));
        return static_cast<int>(std::min<double>(level, mTexture->picture->levels() - 1));
    }

    Vec3f color(const Vec3d& weights, int level) const {
        // From one corner on, so that three equal colours give just that colour.
        Vec3f color = mPaint.color[0];
        for (int k = 1; k < 3; ++k) {
            color += static_cast<float>(weights[k]) * (mPaint.color[k] - mPaint.color[0]);
        }
        if (!isTextured()) return color;
        Vec2d uv(0);
        for (int k = 0; k < 3; ++k) uv += weights[k] * Vec2d(mPaint.uv[k]);
        return color * mTexture->picture->sample(uv, mTexture->wraps, level);
    }

  private:
    const TrianglePaint& mPaint;
    const MeshTexture* mTexture = nullptr;
    double mTexelsPerArea = 0;
};

SurfaceQuadrature quadratureFor(const PaintSampler& paint, const SurfaceQuadrature& plain) {
    if (!paint.isTextured()) return plain;
    SurfaceQuadrature quadrature;
    quadrature.triangleEdge.fill(kTexturedEdges.back());
    quadrature.triangleEdge[0] = kTexturedEdges[0];
    if (paint.texelsPerArea() * kFarTexels * kFarTexels > 1) {
        quadrature.triangleEdge[1] = kTexturedEdges[1];
    }
    return quadrature;
}

}  // namespace

void sampleColors(const ColoredMesh& mesh, std::size_t i, const SamplingRegion& region,
                  const SurfaceQuadrature& quadrature, std::vector<ColoredSample>& samples) {
    const TrianglePaint& paint = mesh.paints[i];
    if (paint.texture == TrianglePaint::kNoColor) return;

    // Work relative to a whole voxel at the triangle, as MeshSource does.
    const openvdb::Vec3I& t = mesh.mesh.triangles[i];
    std::array<BarycentricCorner, 3> corner;
    for (int k = 0; k < 3; ++k) {
        corner[k].place = mesh.mesh.points[t[k]] / region.voxelSize;
        corner[k].weights = Vec3d(0);
        corner[k].weights[k] = 1;
    }
    const Vec3d& first = corner[0].place;
    const Vec3d base(std::floor(first[0]), std::floor(first[1]), std::floor(first[2]));
    for (BarycentricCorner& c : corner) c.place -= base;
    const double area =
        0.5 * (corner[1].place - corner[0].place).cross(corner[2].place - corner[0].place).length();
    if (area == 0) return;

    const Vec3d origin = region.origin - base;
    const RegionClip clip({region.voxelSize, origin, region.extent});
    const PaintSampler sampler(mesh, paint, area);
    const auto append = [&](const TriangleCell<BarycentricCorner>& cell) {
        const double cellArea = cell.share * area;
        const int level = sampler.levelFor(cellArea / static_cast<double>(cell.rule.size()));
        for (const TrianglePoint& p : cell.rule) {
            const auto mixed = [&](const Vec3d BarycentricCorner::*of) {
                return p.a * (cell.corner[0].*of) + p.b * (cell.corner[1].*of) +
                       p.c * (cell.corner[2].*of);
            };
            const Vec3d place = mixed(&BarycentricCorner::place);
            if (!clip.holds(place)) continue;
            samples.push_back({Vec3f(place - origin), static_cast<float>(p.weight * cellArea),
                               sampler.color(mixed(&BarycentricCorner::weights), level)});
        }
    };
    sampleTriangle(corner, quadratureFor(sampler, quadrature), clip, append);
}

}  // namespace bandvox
