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

Texture checker(int side) {
    std::vector<std::uint16_t> rgb;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            for (int c = 0; c < 3; ++c) rgb.push_back((x + y) % 2 == 0 ? 65535 : 0);
        }
    }
    return {side, side, std::move(rgb)};
}

// Voxels where two grids differ, in value or in being active.
int countDifferences(const openvdb::Vec3SGrid& a, const openvdb::Vec3SGrid& b,
                     const Coord& shift = Coord(0)) {
    int differences = 0;
    const auto compare = [&](const openvdb::Vec3SGrid& from, const openvdb::Vec3SGrid& to,
                             const Coord& offset) {
        const auto accessor = to.getConstAccessor();
        for (auto value = from.cbeginValueOn(); value; ++value) {
            const Coord other = value.getCoord() + offset;
            if (!accessor.isValueOn(other) || accessor.getValue(other) != *value) ++differences;
        }
    };
    compare(a, b, shift);
    compare(b, a, -shift);
    return differences;
}

// --- the direct sum -----------------------------------------------------------------------------

TEST(SurfaceToColor, EqualsTheDirectSum) {
    const TurnedBox box{Vec3d(13.1, 9.7, 4.9), Vec3d(0.31, -0.17, 0.43), someRotation()};
    const Mesh ball = ballMesh(11.3, Vec3d(0.21, -0.37, 0.11), 3);
    for (const bool jumps : {false, true}) {
        for (const Mesh& mesh : {box.mesh(1), ball}) {
            const ColoredMesh colored = painted(mesh, 0.03, jumps);
            for (const ExponentialFilter& filter :
                 {ExponentialFilter{2, 0.16}, {2, 0.1}, {4, 0.2}}) {
                const DirectColor truth(colored.mesh, 1, colorFilter(filter).cutoff, 0.25,
                                        cornerPaint(colored));
                for (const int tile : {0, 44}) {
                    ColorOptions options = colorOptions(filter);
                    options.tile = tile;
                    const ColorResult result = surfaceToColor(colored, options);
                    EXPECT_LE(truth.largestError(*result.grid, 101), 5e-4)
                        << jumps << " " << mesh.points.size() << " " << filter.order << " "
                        << filter.cutoff << " " << tile;
                }
            }
        }
    }
}

TEST(SurfaceToColor, EveryResolutionEqualsTheDirectSum) {
    const ColoredMesh colored = painted(test::cube(Vec3d(-1, -0.9, -1.1), 2), 0.4, true);
    for (const double resolution : {3.0, 10.0, 33.3}) {
        const double voxelSize = 2 / resolution;
        const DirectColor truth(colored.mesh, voxelSize, 0.16, 0.25, cornerPaint(colored));
        const ColorResult result = surfaceToColor(colored, colorOptions({}, voxelSize));
        EXPECT_DOUBLE_EQ(result.grid->voxelSize().x(), voxelSize);
        EXPECT_LE(truth.largestError(*result.grid, resolution > 20 ? 101 : 7), 1e-3) << resolution;
    }
}

// Texels that are black or white at random are the hardest; of those that are finer than half a
// voxel the points see too few, or a coarser level. Far beyond the rim of the square the few that
// are nearest make the colour.
TEST(SurfaceToColor, TexturesEqualTheDirectSum) {
    const double side = 14.3;
    const int texels = 16;
    for (const double texel : {0.1, 0.25, 0.5, 1.0, 1.7, 5.0}) {
        const ColoredMesh mesh =
            texturedSquare(side, 0.3, side / (texel * texels), noise(texels, 5));
        const DirectColor truth(mesh.mesh, 1, 0.16, std::min(0.12, 0.2 * texel),
                                texturePaint(mesh));
        const ColorResult result = surfaceToColor(mesh, colorOptions({}));
        EXPECT_LE(truth.largestError(*result.grid, 41, 0.5), texel < 0.5 ? 1.2e-2 : 2e-3) << texel;
        EXPECT_LE(truth.largestError(*result.grid, 41), texel < 0.5 ? 3e-2 : 3e-3) << texel;
    }
}

// --- exact properties ---------------------------------------------------------------------------

TEST(SurfaceToColor, OneColorComesOutExactly) {
    const Vec3f color(0.1F, 0.7F, 0.3F);
    for (const Mesh& mesh :
         {test::cube(Vec3d(0.3), 20), test::soup(test::tetrahedron(Vec3d(0), 30)),
          ballMesh(9, Vec3d(0.2), 4)}) {
        for (const ExponentialFilter& filter : {ExponentialFilter{2, 0.16}, {8, 0.35}}) {
            const ColorResult result = surfaceToColor(oneColor(mesh, color), colorOptions(filter));
            EXPECT_GT(result.grid->activeVoxelCount(), 1000u);
            for (auto value = result.grid->cbeginValueOn(); value; ++value) {
                ASSERT_EQ(*value, color) << value.getCoord();
            }
        }
    }
}

TEST(SurfaceToColor, OneColorOfATextureComesOutExactly) {
    const Texture plain(8, 4, std::vector<std::uint16_t>(3 * 8 * 4, 12345));
    const ColorResult result = surfaceToColor(texturedSquare(20, 0.3, 1, plain), colorOptions({}));
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        for (int k = 0; k < 3; ++k) ASSERT_NEAR((*value)[k], 12345 / 65535.0, 1e-7);
    }
}

TEST(SurfaceToColor, TexelsFarFinerThanVoxelsGiveTheirMean) {
    for (const double texel : {0.03, 0.06, 0.11}) {
        const double side = 17.7;
        const ColoredMesh mesh = texturedSquare(side, 0.3, side / (64 * texel), checker(64));
        const ColorResult result = surfaceToColor(mesh, colorOptions({}));
        for (auto value = result.grid->cbeginValueOn(); value; ++value) {
            for (int k = 0; k < 3; ++k) ASSERT_NEAR((*value)[k], 0.5, 1e-3) << texel;
        }
    }
}

TEST(SurfaceToColor, LiesBetweenTheColorsOfTheSurface) {
    const ColoredMesh mesh = painted(ballMesh(7, Vec3d(0.1), 2), 0, true);
    Vec3f low(1), high(0);
    for (const TrianglePaint& paint : mesh.paints) {
        low = openvdb::math::minComponent(low, paint.color[0]);
        high = openvdb::math::maxComponent(high, paint.color[0]);
    }
    const ColorResult result = surfaceToColor(mesh, colorOptions({8, 0.35}));
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        for (int k = 0; k < 3; ++k) {
            ASSERT_GE((*value)[k], low[k]);
            ASSERT_LE((*value)[k], high[k]);
        }
    }
}

TEST(SurfaceToColor, IsTheSameForAnyNumberOfThreads) {
    const ColoredMesh mesh = painted(ballMesh(60, Vec3d(0.3), 4), 0.01, true);
    const ThreadLimit one(1);
    const ColorResult alone = surfaceToColor(mesh, colorOptions({}));
    const ThreadLimit two(2);
    const ColorResult together = surfaceToColor(mesh, colorOptions({}));
    EXPECT_GT(alone.tiles, 8);
    EXPECT_EQ(countDifferences(*alone.grid, *together.grid), 0);
}

TEST(SurfaceToColor, MovesWithTheMeshByWholeVoxels) {
    ColoredMesh mesh = painted(test::cube(Vec3d(0.25, 0.5, 0.125), 40), 0.01, true);
    const ColorResult before = surfaceToColor(mesh, colorOptions({}));
    const Coord shift(1000, -300, 7);
    for (Vec3d& point : mesh.mesh.points) point += shift.asVec3d();
    const ColorResult after = surfaceToColor(mesh, colorOptions({}));
    EXPECT_EQ(countDifferences(*before.grid, *after.grid, shift), 0);
}

TEST(SurfaceToColor, DoesNotSeeOrientationAndHoles) {
    ColoredMesh mesh = painted(test::cube(Vec3d(0.3), 20), 0.01, false);
    const ColorResult whole = surfaceToColor(mesh, colorOptions({}));
    ColoredMesh turned = mesh;
    for (std::size_t i = 0; i < turned.paints.size(); i += 3) {
        std::swap(turned.mesh.triangles[i][1], turned.mesh.triangles[i][2]);
        std::swap(turned.paints[i].color[1], turned.paints[i].color[2]);
    }
    const ColorResult other = surfaceToColor(turned, colorOptions({}));
    ASSERT_EQ(whole.grid->activeVoxelCount(), other.grid->activeVoxelCount());
    const auto accessor = other.grid->getConstAccessor();
    for (auto value = whole.grid->cbeginValueOn(); value; ++value) {
        ASSERT_LE((*value - accessor.getValue(value.getCoord())).length(), 3e-4);
    }
}

// --- where it is active -------------------------------------------------------------------------

// Every cell that the iso-surface passes has the 4³ nodes that cubic interpolation there needs.
TEST(SurfaceToColor, IsActiveWhereTheSurfaceIsInterpolated) {
    const TurnedBox box{Vec3d(12.1, 7.7, 2.4), Vec3d(0.31, -0.17, 0.43), someRotation()};
    for (const Mesh& mesh : {box.mesh(1), test::cube(Vec3d(0.37), 9),
                             test::tetrahedron(Vec3d(0), 22), ballMesh(2.9, Vec3d(0.2), 3)}) {
        for (const ExponentialFilter& filter :
             {ExponentialFilter{2, 0.16}, {2, 0.08}, {2, 0.3}, {4, 0.28}, {8, 0.35}}) {
            DensityOptions options;
            options.filter = filter;
            options.voxelSize = 1;
            const DensityResult density = surfaceToDensity(MeshSource("mesh", mesh), options);
            const ColorResult color =
                surfaceToColor(oneColor(mesh, Vec3f(1)), colorOptions(filter));
            const auto values = density.grid->getConstAccessor();
            const auto colors = color.grid->getConstAccessor();
            int crossed = 0;
            openvdb::CoordBBox cells = density.grid->evalActiveVoxelBoundingBox();
            for (auto cell = cells.begin(); cell; ++cell) {
                float low = 2;
                float high = -1;
                const openvdb::CoordBBox corners(*cell, *cell + Coord(1));
                for (auto corner = corners.begin(); corner; ++corner) {
                    low = std::min(low, values.getValue(*corner));
                    high = std::max(high, values.getValue(*corner));
                }
                if (low >= 0.5F || high < 0.5F) continue;
                ++crossed;
                const openvdb::CoordBBox nodes(*cell - Coord(1), *cell + Coord(2));
                for (auto node = nodes.begin(); node; ++node) {
                    ASSERT_TRUE(colors.isValueOn(*node))
                        << *cell << *node << " " << filter.order << " " << filter.cutoff;
                }
            }
            EXPECT_TRUE(crossed > 50 || filter.cutoff == 0.08) << crossed;
        }
    }
}

TEST(SurfaceToColor, IsInactiveFarFromTheSurface) {
    const ColoredMesh mesh = oneColor(test::cube(Vec3d(0), 40), Vec3f(0.5F));
    const ColorResult result = surfaceToColor(mesh, colorOptions({}));
    EXPECT_EQ(result.grid->getName(), "Cd");
    EXPECT_EQ(result.grid->getGridClass(), openvdb::GRID_UNKNOWN);
    EXPECT_EQ(result.grid->getVectorType(), openvdb::VEC_INVARIANT);
    EXPECT_EQ(result.grid->background(), Vec3f(0));
    const openvdb::Vec3STree& tree = result.grid->tree();
    for (const int x : {-4, -2, 0, 2, 4}) EXPECT_TRUE(tree.isValueOn({x, 20, 20})) << x;
    for (const int x : {-6, 6, 20, 34, 46}) EXPECT_FALSE(tree.isValueOn({x, 20, 20})) << x;
}

TEST(SurfaceToColor, TrianglesWithoutColorDoNotCount) {
    ColoredMesh mesh = oneColor(test::cube(Vec3d(0), 40), Vec3f(0.5F));
    for (std::size_t i = 0; i < 2; ++i) mesh.paints[i].texture = TrianglePaint::kNoColor;
    const ColorResult result = surfaceToColor(mesh, colorOptions({}));
    EXPECT_FALSE(result.grid->tree().isValueOn({0, 20, 20}));
    EXPECT_TRUE(result.grid->tree().isValueOn({40, 20, 20}));
    EXPECT_TRUE(result.grid->tree().isValueOn({0, 20, 2})) << "beside the rim";
}

// --- what is refused ----------------------------------------------------------------------------

TEST(SurfaceToColor, FilterIsTheDensitysUnlessItRings) {
    EXPECT_EQ(colorFilter({2, 0.16}).cutoff, 0.16);
    EXPECT_EQ(colorFilter({2, 0.07}).cutoff, 0.07);
    EXPECT_EQ(colorFilter({2, 0.3}).cutoff, 0.16);
    const ExponentialFilter sharp{8, 0.1};
    const ExponentialFilter smooth = colorFilter(sharp);
    EXPECT_EQ(smooth.order, 2);
    // Half of it is left at the same frequency.
    EXPECT_NEAR(smooth(0.1 * std::pow(std::log(2), 1 / 8.0)), 0.5, 1e-12);
}

TEST(SurfaceToColor, RefusesWhatGivesNoGrid) {
    const auto kindOf = [](const ColoredMesh& mesh, const ColorOptions& options) {
        try {
            surfaceToColor(mesh, options);
        } catch (const Error& error) {
            EXPECT_FALSE(std::string(error.what()).empty());
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    const ColoredMesh mesh = oneColor(test::cube(Vec3d(0), 4), Vec3f(1));
    ColoredMesh plain = mesh;
    for (TrianglePaint& paint : plain.paints) paint.texture = TrianglePaint::kNoColor;
    EXPECT_EQ(kindOf(plain, colorOptions({})), ErrorKind::Result);
    ColoredMesh flat = mesh;
    for (Vec3d& point : flat.mesh.points) point = Vec3d(point.x(), 0, 0);
    EXPECT_EQ(kindOf(flat, colorOptions({})), ErrorKind::Result);
    EXPECT_EQ(kindOf({}, colorOptions({})), ErrorKind::Result);
    EXPECT_EQ(kindOf(mesh, colorOptions({}, 0)), ErrorKind::Usage);
    EXPECT_EQ(kindOf(mesh, colorOptions({}, -1)), ErrorKind::Usage);
    EXPECT_EQ(kindOf(mesh, colorOptions({}, std::numeric_limits<double>::quiet_NaN())),
              ErrorKind::Usage);
    EXPECT_EQ(kindOf(mesh, colorOptions({0.5, 0.16})), ErrorKind::Usage);
    ColorOptions small = colorOptions({});
    small.tile = 8;
    EXPECT_EQ(kindOf(mesh, small), ErrorKind::Usage);
    EXPECT_EQ(kindOf(mesh, colorOptions({}, 1e-5)), ErrorKind::Memory);
}

}  // namespace
}  // namespace bandvox
