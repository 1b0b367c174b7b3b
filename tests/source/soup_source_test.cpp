#include "soup_meshes.h"
#include "source/winding_rows.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/joined_source.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/soup_source.h>
#include <bandvox/source/winding_number.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;

BBoxd boundsOf(const Mesh& mesh) {
    BBoxd box;
    for (const Vec3d& p : mesh.points) box.expand(p);
    return box;
}

WindingRows rowsOf(const Mesh& mesh, double voxelSize, int perSide) {
    return {WindingTree(mesh), boundsOf(mesh), RowLattice::turned(voxelSize, perSide),
            silentProgress()};
}

template <typename Visit>
void forEachRow(const WindingRows& rows, const Visit& visit) {
    const openvdb::Coord bundles = rows.bundleCount();
    for (std::int64_t b = 0; b < std::int64_t(bundles.y()) * bundles.z(); ++b) {
        for (int voxel = 0; voxel < WindingRows::kSide * WindingRows::kSide; ++voxel) {
            for (int i = 0; i < rows.lattice().rowCount(); ++i) {
                const int y = voxel / WindingRows::kSide, z = voxel % WindingRows::kSide;
                const RowLattice::Place& at = rows.lattice().rows[i];
                visit(rows.lattice().voxelSize * (rows.firstVoxel(b).y() + y + at.y),
                      rows.lattice().voxelSize * (rows.firstVoxel(b).z() + z + at.z),
                      rows.row(b, y, z, i));
            }
        }
    }
}

TEST(RowLattice, NoTwoRowsShareACoordinate) {
    for (const int side : {1, 2, 3, 4, 8, 16, 64}) {
        const RowLattice lattice = RowLattice::turned(1, side);
        std::set<double> y, z;
        for (const RowLattice::Place& place : lattice.rows) {
            EXPECT_TRUE(place.y > 0 && place.y < 1 && place.z > 0 && place.z < 1);
            y.insert(place.y);
            z.insert(place.z);
        }
        EXPECT_EQ(y.size(), std::size_t(side) * side + 1);
        EXPECT_EQ(z.size(), std::size_t(side) * side + 1);
    }
}

// The rows of the wider lattice are the others' places, doubled about one of them.
TEST(RowLattice, TheWiderOneIsTheSameTwiceAsWide) {
    for (const int side : {1, 2, 3, 4, 7, 8}) {
        const RowLattice lattice = RowLattice::turned(1, side);
        const int n = lattice.rowCount();
        const auto whole = [n](double at) { return std::lround(at * n - 0.5); };
        std::set<std::pair<long, long>> doubled, wider;
        for (int y = -6; y <= 6; ++y) {
            for (int z = -6; z <= 6; ++z) {
                for (int i = 0; i < n; ++i) {
                    const std::pair at(y * n + whole(lattice.rows[i].y),
                                       z * n + whole(lattice.rows[i].z));
                    const std::pair twice(2 * at.first, 2 * at.second);
                    if (std::abs(twice.first) < 4 * n && std::abs(twice.second) < 4 * n) {
                        doubled.insert(twice);
                    }
                    if (std::abs(at.first) < 4 * n && std::abs(at.second) < 4 * n &&
                        lattice.isOfWiderLattice(y, z, i)) {
                        wider.insert(at);
                    }
                }
            }
        }
        EXPECT_EQ(doubled, wider) << side;
    }
}

TEST(WindingRows, ClosedFormOfABall) {
    // Fine enough that its triangles lie within 1e-3 voxels of the ball.
    const Mesh mesh = test::sphere(Vec3d(0.3, 0.1, -0.2), 1, 400, 800);
    const WindingRows rows = rowsOf(mesh, 0.1, 3);
    int hits = 0;
    forEachRow(rows, [&](double y, double z, std::span<const float> row) {
        const double square = 1 - std::pow(y - 0.1, 2) - std::pow(z + 0.2, 2);
        if (std::abs(square) < 1e-2) return;
        ASSERT_EQ(row.size(), square > 0 ? 2u : 0u);
        if (square < 0) return;
        ++hits;
        for (const int end : {0, 1}) {
            const double x = 0.1 * (rows.xOrigin() + row[end]);
            EXPECT_NEAR(x, 0.3 + (2 * end - 1) * std::sqrt(square), 1e-3);
        }
    });
    EXPECT_GT(hits, 2000);
    // Nothing had to be asked: it is closed.
    EXPECT_EQ(rows.evaluations(), 0);
}

// Along every row, the winding number decides, by the exact sum.
void expectRight(const Mesh& mesh, double voxelSize, int perSide, double most) {
    const WindingRows rows = rowsOf(mesh, voxelSize, perSide);
    const WindingNumber winding(mesh);
    const BBoxd box = boundsOf(mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<> along(box.min().x(), box.max().x());
    int asked = 0, wrong = 0, count = 0;
    forEachRow(rows, [&](double y, double z, std::span<const float> row) {
        for (std::size_t i = 1; i < row.size(); ++i) ASSERT_LE(row[i - 1], row[i]);
        ASSERT_EQ(row.size() % 2, 0u);
        if (++count % 5 != 0) return;
        const double x = along(random);
        const double exact = winding.exactAt({x, y, z});
        if (std::abs(exact - WindingMap::kInside) < 0.02) return;
        const double at = x / voxelSize - rows.xOrigin();
        const auto passed = std::lower_bound(row.begin(), row.end(), at) - row.begin();
        ++asked;
        wrong += (passed % 2 == 1) == (exact > WindingMap::kInside) ? 0 : 1;
    });
    EXPECT_GT(asked, 100);
    EXPECT_LE(wrong, most * asked) << wrong << " of " << asked;
}

TEST(WindingRows, FollowTheWindingNumber) {
    expectRight(test::askew(test::panels(0.05)), 0.05, 2, 0);
    expectRight(test::panels(0.05), 0.05, 2, 0);
    expectRight(test::askew(test::panels(0.3)), 0.05, 2, 0);
    const Mesh ball = test::sphere(Vec3d(0.0), 1, 40, 60);
    expectRight(test::shredded(ball, 0.1), 0.05, 2, 0.002);
    expectRight(test::shredded(ball, 0.5), 0.05, 2, 0.005);
    expectRight(test::thinned(ball, 0.3, 9), 0.05, 2, 0.005);
    expectRight(test::thinned(ball, 0.6, 9), 0.06, 1, 0.01);
}

TEST(WindingRows, UniteWhatOverlapsAndKeepCavities) {
    Mesh mesh = test::cube(Vec3d(-1.0), 2);
    test::append(mesh, test::reversed(test::cube(Vec3d(-0.5), 1)));
    test::append(mesh, test::cube(Vec3d(0.6, 0.6, 0.6), 1));
    expectRight(mesh, 0.05, 2, 0);
}

TEST(SoupSource, VolumeAndClosure) {
    const SoupSource source("panels", test::askew(test::panels(0.01)),
                            {.voxelSize = 0.05, .rowsPerVoxel = 4});
    EXPECT_NEAR(source.volume(), 8, 0.02);
    EXPECT_NEAR(source.withFewerRows()->volume(), 8, 0.1);
    EXPECT_NEAR(double(source.rowCount()) / double(source.withFewerRows()->rowCount()), 4, 0.05);
    // What enters leaves again.
    std::vector<SurfaceSample> samples;
    const SamplingRegion all{0.05, source.bounds().min() / 0.05 - Vec3d(1),
                             source.bounds().extents() / 0.05 + Vec3d(2)};
    for (std::size_t i = 0; i < source.elementCount(); ++i) {
        source.sampleElement(i, all, {}, samples);
        const BBoxd box = source.elementBounds(i);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(box.min()[axis], source.bounds().min()[axis]);
            EXPECT_LE(box.max()[axis], source.bounds().max()[axis]);
        }
    }
    double sum = 0, volume = 0;
    for (const SurfaceSample& s : samples) {
        sum += s.areaVector.x();
        volume += double(s.areaVector.x()) * s.position.x();
        EXPECT_EQ(s.areaVector.y(), 0);
    }
    EXPECT_NEAR(sum, 0, 1e-3);
    EXPECT_NEAR(volume * std::pow(0.05, 3), source.volume(), 1e-3);
}

TEST(SoupSource, RegionsShareTheSamples) {
    const SoupSource source("panels", test::askew(test::panels(0.1)), {.voxelSize = 0.1});
    const auto count = [&](const Vec3d& low, const Vec3d& size) {
        std::vector<SurfaceSample> samples;
        for (std::size_t i = 0; i < source.elementCount(); ++i) {
            source.sampleElement(i, {0.1, low, size}, {}, samples);
        }
        return std::count_if(samples.begin(), samples.end(),
                             [](const SurfaceSample& s) { return s.areaVector.x() != 0; });
    };
    const auto whole = count(Vec3d(-32.0), Vec3d(64.0));
    std::ptrdiff_t parts = 0;
    for (int i = 0; i < 8; ++i) {
        parts += count(Vec3d(i & 1 ? 0 : -32, i & 2 ? 0 : -32, i & 4 ? 0 : -32), Vec3d(32.0));
    }
    EXPECT_EQ(whole, parts);
    EXPECT_GT(whole, 1000);
}

TEST(SoupSource, TakesAwayWhatIsInASolid) {
    const Mesh solid = test::cube(Vec3d(0.0), 2);
    const SoupSource source("panels", test::panels(0.001),
                            {.voxelSize = 0.05, .rowsPerVoxel = 4, .solid = &solid});
    EXPECT_NEAR(source.volume(), 7, 0.05);
    const MeshSource mesh("solid", solid);
    const JoinedSource joined("both", {&source, &mesh});
    EXPECT_NEAR(joined.volume(), 15, 0.05);
    EXPECT_EQ(joined.elementCount(), source.elementCount() + 12);
    EXPECT_EQ(joined.elementBounds(source.elementCount() + 3), mesh.elementBounds(3));
    EXPECT_EQ(joined.bounds().max(), Vec3d(2.0));
}

TEST(SoupSource, SaysWhatCannotBe) {
    const auto kind = [](const Mesh& mesh, const SoupOptions& options) {
        try {
            const SoupSource source("a", mesh, options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    Mesh sheet = test::panels(0.1);
    sheet.triangles.resize(2);
    EXPECT_EQ(kind(sheet, {.voxelSize = 0.1}), ErrorKind::Result);
    EXPECT_EQ(kind(test::panels(0.1), {.voxelSize = 0}), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), {.voxelSize = std::nan("")}), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), {.voxelSize = 0.1, .rowsPerVoxel = 0}), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), {.voxelSize = 0.1, .rowsPerVoxel = 65}), ErrorKind::Usage);
    EXPECT_EQ(kind(test::panels(0.1), {.voxelSize = 1e-6}), ErrorKind::Memory);
}

TEST(SoupSource, IsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = test::shredded(test::sphere(Vec3d(0.0), 1, 40, 60), 0.3);
    const auto sampled = [&](int threads) {
        const ThreadLimit limit(threads);
        const SoupSource source("a", mesh, {.voxelSize = 0.05});
        return std::pair(source.volume(), source.evaluations());
    };
    EXPECT_EQ(sampled(1), sampled(3));
}

}  // namespace
}  // namespace bandvox
