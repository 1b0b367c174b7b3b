// Table 1 of N. Nakamura et al.: "Fast Generation Method from Boundary Representation Model to
// Binary Voxel Data by Using GPU": the mean distance from the centres of surface voxels to the true
// surface, before and after their improvement; and beside it that of the surface where a
// band-limited density of as many voxels is 0.5.

#include "experiments.h"
#include "measure.h"
#include "paper_shapes.h"
#include "source/triangle_distance.h"
#include "source/winding_tree.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/parallel.h>
#include <bandvox/voxelize/mesh_to_voxels.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr int kResolution = 512;
constexpr int kPlaces = 4000;

// A part of a surface is smooth where, within this many voxels, its normals differ by less.
constexpr double kSmoothReach = 6;
constexpr double kSmoothAngle = 15 * std::numbers::pi / 180;

// Voxels inside that have a neighbour across a face that is not.
std::vector<openvdb::Coord> surfaceVoxels(const openvdb::FloatGrid& voxels) {
    openvdb::MaskTree all(voxels.tree(), false, openvdb::TopologyCopy());
    all.voxelizeActiveTiles();
    openvdb::MaskTree deep(all);
    openvdb::tools::erodeActiveValues(deep, 1, openvdb::tools::NN_FACE,
                                      openvdb::tools::IGNORE_TILES);
    all.topologyDifference(deep);
    std::vector<openvdb::Coord> found;
    for (auto value = all.cbeginValueOn(); value; ++value) found.push_back(value.getCoord());
    return found;
}

struct DistanceStatistics {
    double mean = 0, largest = 0;
    std::int64_t count = 0;
};

template <typename Distance>
DistanceStatistics statisticsOf(std::int64_t count, const Distance& distance) {
    std::vector<double> found(count);
    constexpr std::int64_t kTogether = 4096;
    parallelFor((count + kTogether - 1) / kTogether, [&](std::int64_t task) {
        for (std::int64_t i = task * kTogether; i < std::min(count, (task + 1) * kTogether); ++i) {
            found[i] = distance(i);
        }
    });
    DistanceStatistics statistics{0, 0, count};
    for (const double d : found) {
        statistics.mean += d / static_cast<double>(count);
        statistics.largest = std::max(statistics.largest, d);
    }
    return statistics;
}

// From the centres of surface voxels to the mesh, voxels.
DistanceStatistics distanceOfVoxels(const openvdb::FloatGrid& voxels, const WindingTree& surface) {
    const double voxelSize = voxels.voxelSize().x();
    const std::vector<openvdb::Coord> centers = surfaceVoxels(voxels);
    return statisticsOf(std::ssize(centers), [&](std::int64_t i) {
        const Vec3d place = voxelSize * centers[i].asVec3d();
        constexpr double kReach = 3;  // no centre is that far away
        double nearest = kReach * voxelSize;
        surface.visitNear({place, nearest}, [&](std::uint32_t t) {
            nearest = std::min(nearest, distanceToTriangle(place, surface.corners(t)));
        });
        return nearest / voxelSize;
    });
}

struct SurfacePlace {
    Vec3d point, normal;  // world units
};

Vec3d normalOf(const std::array<Vec3d, 3>& corner) {
    Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    normal.normalize();
    return normal;
}

bool isSmoothAt(const SurfacePlace& place, const WindingTree& surface, double voxelSize) {
    const double reach = kSmoothReach * voxelSize;
    bool isSmooth = true;
    surface.visitNear({place.point, reach}, [&](std::uint32_t t) {
        const std::array<Vec3d, 3> corner = surface.corners(t);
        if (normalOf(corner).dot(place.normal) < std::cos(kSmoothAngle) &&
            distanceToTriangle(place.point, corner) < reach) {
            isSmooth = false;
        }
    });
    return isSmooth;
}

// Places on smooth parts, spread evenly by area.
std::vector<SurfacePlace> smoothPlaces(const WindingTree& surface, double voxelSize) {
    std::vector<double> area;
    for (std::uint32_t t = 0; t < surface.triangleCount(); ++t) {
        const std::array<Vec3d, 3> c = surface.corners(t);
        area.push_back((c[1] - c[0]).cross(c[2] - c[0]).length());
    }
    std::mt19937 random(1);
    std::discrete_distribution<std::uint32_t> triangle(area.begin(), area.end());
    std::uniform_real_distribution<> uniform(0, 1);
    std::vector<SurfacePlace> places;
    while (places.size() < kPlaces) {
        const std::array<Vec3d, 3> corner = surface.corners(triangle(random));
        double u = uniform(random), v = uniform(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const SurfacePlace place{
            corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]),
            normalOf(corner)};
        if (isSmoothAt(place, surface, voxelSize)) places.push_back(place);
    }
    return places;
}

// From places on the mesh along the normal to where the density is 0.5, voxels.
DistanceStatistics distanceOfDensity(const MeshSource& mesh, const WindingTree& surface,
                                     const ExponentialFilter& filter, double voxelSize) {
    const std::vector<SurfacePlace> places = smoothPlaces(surface, voxelSize);
    DensityOptions options;
    options.voxelSize = voxelSize;
    options.filter = filter;
    const DensityReader density(surfaceToDensity(mesh, options).grid, filter);
    std::vector<double> found;
    for (const SurfacePlace& place : places) {
        constexpr double kReach = 2;
        const std::optional<double> at = density.firstBelow(
            0.5, place.point / voxelSize - kReach * place.normal, place.normal, 2 * kReach);
        found.push_back(at ? std::abs(*at - kReach) : kReach);
    }
    return statisticsOf(std::ssize(found), [&](std::int64_t i) { return found[i]; });
}

}  // namespace

void measureVoxelAccuracy(const Folder& folder) {
    openvdb::initialize();
    Table table =
        folder.table("voxel_accuracy", "shape,what,threshold,order,cutoff,mean,largest,count");
    for (const MeshSource& mesh : {chair(), propeller()}) {
        const WindingTree surface(mesh.mesh());
        const Vec3d size = mesh.bounds().extents();
        const double voxelSize = std::max({size.x(), size.y(), size.z()}) / kResolution;
        for (int threshold = 0; threshold <= 8; ++threshold) {
            const VoxelResult voxels =
                meshToVoxels(mesh, {.voxelSize = voxelSize, .threshold = threshold});
            const DistanceStatistics found = distanceOfVoxels(*voxels.grid, surface);
            table.add(mesh.name(), "voxels", threshold, "", "", found.mean, found.largest,
                      found.count);
        }
        for (const ExponentialFilter& filter : kFilters) {
            const DistanceStatistics found = distanceOfDensity(mesh, surface, filter, voxelSize);
            table.add(mesh.name(), "density", "", filter.order, filter.cutoff, found.mean,
                      found.largest, found.count);
        }
    }
}

}  // namespace bandvox::experiments
