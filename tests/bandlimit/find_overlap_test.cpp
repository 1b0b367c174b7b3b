#include "bandlimit/closed_form_density.h"
#include "source/test_meshes.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/mesh_source.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

const ExponentialFilter kFilters[] = {{2, 0.16}, {4, 0.25}, {4, 0.28}, {8, 0.35}};

DensityResult densityOf(const BoundarySource& source, const ExponentialFilter& filter) {
    DensityOptions options;
    options.filter = filter;
    options.voxelSize = 1;
    return surfaceToDensity(source, options);
}

bool isOverlapSaid(const DensityResult& result) {
    return std::any_of(
        result.warnings.begin(), result.warnings.end(),
        [](const std::string& warning) { return warning.find("overlap") != std::string::npos; });
}

Mesh together(Mesh a, const Mesh& b) {
    test::append(a, b);
    return a;
}

// Two boxes of 24 voxels, turned alike, of which the second begins `gap` behind the first.
Mesh twoBoxes(double gap) {
    const TurnedBox first{Vec3d(12), Vec3d(0.31, -0.17, 0.43), someRotation()};
    TurnedBox second = first;
    second.center += first.rotation * Vec3d(24 + gap, 0, 0);
    return together(first.mesh(1), second.mesh(1));
}

TEST(FindOverlap, ShellsThatOverlapFarAreLimitedAndSaid) {
    const MeshSource source("two",
                            together(ballMesh(30, Vec3d(0), 4), ballMesh(30, Vec3d(20, 0, 0), 4)));
    for (const ExponentialFilter& filter : kFilters) {
        const DensityResult result = densityOf(source, filter);
        ASSERT_EQ(result.warnings.size(), 1U) << filter.order;
        EXPECT_TRUE(isOverlapSaid(result));
        EXPECT_EQ(result.grid->tree().getValue(Coord(10, 0, 0)), 1);
        EXPECT_TRUE(result.metadata.clamped);
    }
}

// Too thin for any voxel to be away from the surface.
TEST(FindOverlap, ThinOverlapsAreFoundUnderEveryFilter) {
    for (const double overlap : {0.5, 1.0, 3.0}) {
        const MeshSource source("two", twoBoxes(-overlap));
        for (const ExponentialFilter& filter : kFilters) {
            const DensityResult result = densityOf(source, filter);
            EXPECT_TRUE(isOverlapSaid(result)) << overlap << " " << filter.order;
            EXPECT_TRUE(result.metadata.clamped);
            for (auto value = result.grid->cbeginValueOn(); value; ++value) {
                ASSERT_GE(*value, 0);
                ASSERT_LE(*value, 1);
            }
        }
    }
}

// A thin part that is inside out in a solid that is not.
TEST(FindOverlap, ThinPartsInsideOutAreFoundUnderEveryFilter) {
    const Mesh plate = TurnedBox{Vec3d(1, 8, 8), Vec3d(40, 0, 0), someRotation()}.mesh(1);
    const MeshSource source("plate", together(ballMesh(12, Vec3d(0), 4), test::reversed(plate)));
    for (const ExponentialFilter& filter : kFilters) {
        EXPECT_TRUE(isOverlapSaid(densityOf(source, filter))) << filter.order;
    }
}

TEST(FindOverlap, RingingIsNone) {
    std::vector<MeshSource> sources;
    sources.emplace_back("ball", ballMesh(20, Vec3d(0), 5));
    for (const double thickness : {1.0, 2.0, 2.5, 3.0}) {
        // Both faces' ringing adds up, and that of the corners.
        sources.emplace_back(
            "plate", TurnedBox{Vec3d(0.5 * thickness, 14, 10), Vec3d(0.3), someRotation()}.mesh(1));
    }
    sources.emplace_back("gap", twoBoxes(2));
    for (const MeshSource& source : sources) {
        for (const ExponentialFilter& filter : kFilters) {
            const DensityResult result = densityOf(source, filter);
            EXPECT_FALSE(isOverlapSaid(result)) << source.name() << " " << filter.order;
            EXPECT_FALSE(result.metadata.clamped);
        }
    }
}

}  // namespace
}  // namespace bandvox
