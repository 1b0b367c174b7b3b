#include "bandlimit/closed_form_density.h"
#include "bandlimit/direct_color.h"
#include "source/test_meshes.h"

#include <bandvox/bandlimit/surface_to_color.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;
using openvdb::Vec3f;

ColorOptions colorOptions(const ExponentialFilter& filter, double voxelSize = 1) {
    ColorOptions options;
    options.filter = filter;
    options.voxelSize = voxelSize;
    return options;
}

/// A mesh whose points have colours that are linear functions of their places, per triangle with
/// another offset if `jumps`.
ColoredMesh painted(Mesh mesh, double perUnit, bool jumps) {
    ColoredMesh colored{"test", std::move(mesh), {}, {}};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> offset(0, 1);
    for (const openvdb::Vec3I& t : colored.mesh.triangles) {
        TrianglePaint paint;
        const Vec3f jump(offset(random), offset(random), offset(random));
        for (int k = 0; k < 3; ++k) {
            const Vec3d& p = colored.mesh.points[t[k]];
            for (int c = 0; c < 3; ++c) {
                paint.color[k][c] = static_cast<float>(
                    std::clamp(0.5 + perUnit * p[c] + (jumps ? jump[c] - 0.5 : 0.0), 0.0, 1.0));
            }
        }
        paint.texture = TrianglePaint::kNoTexture;
        colored.paints.push_back(paint);
    }
    return colored;
}

ColoredMesh oneColor(Mesh mesh, const Vec3f& color) {
    ColoredMesh colored = painted(std::move(mesh), 0, false);
    for (TrianglePaint& paint : colored.paints) paint.color.fill(color);
    return colored;
}

/// A square of side `side` about the origin of the plane z = `height`, with texture coordinates
/// from 0 to `repeats`.
ColoredMesh texturedSquare(double side, double height, double repeats, const Texture& picture) {
    ColoredMesh colored;
    colored.name = "square";
    const double h = side / 2;
    colored.mesh.points = {Vec3d(-h, -h, height), Vec3d(h, -h, height), Vec3d(h, h, height),
                           Vec3d(-h, h, height)};
    colored.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const auto r = static_cast<float>(repeats);
    const openvdb::Vec2f uv[] = {{0, 0}, {r, 0}, {r, r}, {0, r}};
    for (const openvdb::Vec3I& t : colored.mesh.triangles) {
        TrianglePaint paint;
        paint.color.fill(Vec3f(1));
        for (int k = 0; k < 3; ++k) paint.uv[k] = uv[t[k]];
        paint.texture = 0;
        colored.paints.push_back(paint);
    }
    colored.textures.push_back({std::make_shared<Texture>(picture), {}});
    return colored;
}

Texture noise(int side, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint16_t> rgb;
    for (int i = 0; i < 3 * side * side; ++i) rgb.push_back(random() & 1 ? 65535 : 0);
    return {side, side, std::move(rgb)};
}

DirectColor::Paint texturePaint(const ColoredMesh& mesh) {
    return [&mesh](std::size_t i, const Vec3d& weights) {
        openvdb::Vec2d uv(0);
        for (int k = 0; k < 3; ++k) uv += weights[k] * openvdb::Vec2d(mesh.paints[i].uv[k]);
        return Vec3d(mesh.textures[0].picture->sample(uv, {}, 0));
    };
}

TEST(SurfaceToColor, EqualsTheDirectSum) {
    const TurnedBox box{Vec3d(13.1, 9.7, 4.9), Vec3d(0.31, -0.17, 0.43), someRotation()};
    const Mesh ball = ballMesh(11.3, Vec3d(0.21, -0.37, 0.11), 3);
    for (const bool jumps : {false, true}) {
        for (const Mesh& mesh : {box.mesh(1), ball}) {
            const ColoredMesh colored = painted(mesh, 0.03, jumps);
            for (const ExponentialFilter& filter :
                 {ExponentialFilter{2, 0.16}, ExponentialFilter{2, 0.1},
                  ExponentialFilter{4, 0.28}}) {
                const DirectColor truth(colored.mesh, 1, colorFilter(filter).cutoff, 0.2,
                                        cornerPaint(colored));
                for (const int tile : {0, 44, 32}) {
                    if (tile == 32 && filter.cutoff == 0.1) continue;
                    ColorOptions options = colorOptions(filter);
                    options.tile = tile;
                    const ColorResult result = surfaceToColor(colored, options);
                    EXPECT_LE(truth.largestError(*result.grid, 23), 1e-3)
                        << jumps << " " << mesh.points.size() << " " << filter.order << " "
                        << filter.cutoff << " " << tile;
                    std::printf("jumps %d points %zu filter %g %g tile %d: %g\n", jumps, mesh.points.size(), filter.order, filter.cutoff, tile, truth.largestError(*result.grid, 23));
                }
            }
        }
    }
}

TEST(SurfaceToColor, TexturesEqualTheDirectSum) {
    for (const double texel : {0.1, 0.15, 0.25, 0.35, 0.5, 0.7, 1.0, 1.7, 3.0, 8.0}) {
        const double side = 24.3;
        const int texels = 16;
        const ColoredMesh mesh =
            texturedSquare(side, 0.3, side / (texel * texels), noise(texels, 5));
        const DirectColor truth(mesh.mesh, 1, 0.16, std::max(0.05, 0.1*texel), texturePaint(mesh));
        const ColorResult result = surfaceToColor(mesh, colorOptions({}));
        std::printf("texel %g: %g samples %ld\n", texel, truth.largestError(*result.grid, 41), (long)result.surfaceSamples);
    }
}

}  // namespace
}  // namespace bandvox
