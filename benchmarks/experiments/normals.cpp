// How far the normals of a picture are from the true ones, beside those that OpenVDB's own ray
// intersector finds on a level set of the same resolution.

#include "experiments.h"

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/render/camera.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/source/mesh_source.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/RayIntersector.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Mat3d;
using openvdb::Vec3d;
using std::numbers::pi;

constexpr int kPixels = 512;
constexpr double kSide = 2;  // of the box that a resolution is for

// A smooth solid: its surface as a grid of points, and its true normals.
struct Smooth {
    std::string name;
    std::function<Vec3d(double u, double v)> point;  // u, v from 0 to 1, v periodic
    bool isURing;                                    // periodic in u, too; else poles
    std::function<Vec3d(const Vec3d&)> normal;       // at a place near the surface
};

Mat3d ellipsoidTurn() {
    Mat3d turn;
    turn.setToRotation(Vec3d(0.36, 0.48, 0.8), 0.6);
    return turn;
}

std::vector<Smooth> smoothSolids() {
    const auto ball = [](double u, double v) {
        return Vec3d(std::sin(pi * u) * std::cos(2 * pi * v), -std::cos(pi * u),
                     std::sin(pi * u) * std::sin(2 * pi * v));
    };
    const Vec3d axes(0.9, 0.5, 0.35);
    const Mat3d turn = ellipsoidTurn();
    const Vec3d shift(0.0031, -0.0047, 0.0023);  // nothing lies on the lattice
    return {
        {"sphere", [=](double u, double v) { return 0.93 * ball(u, v) + shift; }, false,
         [=](const Vec3d& p) { return p - shift; }},
        {"torus",
         [=](double u, double v) {
             const double ring = 0.65 + 0.28 * std::cos(2 * pi * u);
             return Vec3d(ring * std::cos(2 * pi * v), 0.28 * std::sin(2 * pi * u),
                          ring * std::sin(2 * pi * v)) +
                    shift;
         },
         true,
         [=](const Vec3d& place) {
             const Vec3d p = place - shift;
             const double ring = std::hypot(p.x(), p.z());
             return p - Vec3d(p.x(), 0, p.z()) * (0.65 / ring);
         }},
        {"ellipsoid", [=](double u, double v) { return turn * (axes * ball(u, v)) + shift; }, false,
         [=](const Vec3d& place) {
             const Vec3d p = turn.transpose() * (place - shift);
             return turn * (p / (axes * axes));
         }},
    };
}

// So fine that its facets are not to be seen at 256 voxels.
Mesh meshOf(const Smooth& solid) {
    constexpr int kAlong = 1200;
    Mesh mesh;
    for (int i = 0; i <= kAlong; ++i) {
        for (int k = 0; k < kAlong; ++k) {
            mesh.points.push_back(
                solid.point(static_cast<double>(i) / kAlong, static_cast<double>(k) / kAlong));
        }
    }
    const auto at = [&](int i, int k) {
        if (solid.isURing) i %= kAlong;
        // All of a pole is one point.
        if (!solid.isURing && (i == 0 || i == kAlong)) k = 0;
        return static_cast<openvdb::Index32>(i * kAlong + k % kAlong);
    };
    for (int i = 0; i < kAlong; ++i) {
        for (int k = 0; k < kAlong; ++k) {
            const auto add = [&](openvdb::Index32 a, openvdb::Index32 b, openvdb::Index32 c) {
                if (a != b && b != c && c != a) mesh.triangles.emplace_back(a, b, c);
            };
            add(at(i, k), at(i + 1, k), at(i + 1, k + 1));
            add(at(i, k), at(i + 1, k + 1), at(i, k + 1));
        }
    }
    const MeshSource source("", mesh);
    if (source.volume() < 0) {
        for (openvdb::Vec3I& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
}

// What was seen at each pixel: a place and a normal, or nothing.
struct Sighting {
    bool isHit = false;
    Vec3d place, normal;
};
using Sightings = std::vector<Sighting>;

CameraOptions view() {
    CameraOptions camera;
    camera.projection = CameraOptions::Projection::Orthographic;
    camera.eye = Vec3d(1.9, 1.3, 3.1);
    camera.lookat = Vec3d(0.0);
    camera.frame = 2.2;
    return camera;
}

Sightings seenByUs(const openvdb::FloatGrid::ConstPtr& density) {
    RenderOptions options;
    options.width = options.height = kPixels;
    options.camera = view();
    const Image image = densityToImage(density, options).image;
    Sightings found(image.depth.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        found[i].isHit = std::isfinite(image.depth[i]);
        for (int axis = 0; axis < 3; ++axis) {
            found[i].place[axis] = image.position[3 * i + axis];
            found[i].normal[axis] = image.normal[3 * i + axis];
        }
    }
    return found;
}

Sightings seenByOpenVdb(const openvdb::FloatGrid& levelSet) {
    const openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid> intersector(levelSet);
    const Camera camera(view(), kPixels, kPixels, {Vec3d(-1.0), Vec3d(1.0)});
    Sightings found(static_cast<std::size_t>(kPixels) * kPixels);
    for (int row = 0; row < kPixels; ++row) {
        for (int column = 0; column < kPixels; ++column) {
            const Ray ray = camera.ray(column + 0.5, row + 0.5);
            Sighting& sighting = found[static_cast<std::size_t>(row) * kPixels + column];
            const openvdb::math::Ray<double> line(ray.origin, ray.direction);
            sighting.isHit = intersector.intersectsWS(line, sighting.place, sighting.normal);
        }
    }
    return found;
}

// The mean angle between the normals seen and the true ones there, degrees, without the pixels at
// the rim, which have a neighbour that sees nothing.
double meanAngle(const Sightings& seen, const Smooth& solid) {
    double sum = 0;
    int count = 0;
    for (int row = 1; row + 1 < kPixels; ++row) {
        for (int column = 1; column + 1 < kPixels; ++column) {
            const auto at = [&](int r, int c) -> const Sighting& {
                return seen[static_cast<std::size_t>(r) * kPixels + c];
            };
            bool isInner = true;
            for (int r = row - 1; r <= row + 1; ++r) {
                for (int c = column - 1; c <= column + 1; ++c) {
                    isInner = isInner && at(r, c).isHit;
                }
            }
            if (!isInner) continue;
            const Vec3d normal = at(row, column).normal;
            const Vec3d truth = solid.normal(at(row, column).place);
            sum += std::atan2(normal.cross(truth).length(), normal.dot(truth));
            ++count;
        }
    }
    return sum / count * 180 / pi;
}

}  // namespace

void measureNormals(const Folder& folder) {
    openvdb::initialize();
    Table table = folder.table("normals", "solid,voxels,bandvox,level_set,ratio");
    for (const Smooth& solid : smoothSolids()) {
        const Mesh mesh = meshOf(solid);
        for (const int voxels : {64, 256}) {
            DensityOptions options;
            options.voxelSize = kSide / voxels;
            const auto density = surfaceToDensity(MeshSource(solid.name, mesh), options).grid;
            const auto transform =
                openvdb::math::Transform::createLinearTransform(options.voxelSize);
            const std::vector<openvdb::Vec3s> points(mesh.points.begin(), mesh.points.end());
            const auto levelSet = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
                *transform, points, mesh.triangles);
            const double ours = meanAngle(seenByUs(density), solid);
            const double theirs = meanAngle(seenByOpenVdb(*levelSet), solid);
            table.add(solid.name, voxels, ours, theirs, ours / theirs);
        }
    }
}

}  // namespace bandvox::experiments
