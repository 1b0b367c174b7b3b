// The winding number of soups: what its tree costs and is wrong by, and how far the density of a
// soup is from the true one, beside what it states.

#include "bandlimit/grid_difference.h"
#include "experiments.h"
#include "measure.h"
#include "paper_shapes.h"
#include "source/winding_tree.h"

#include <bandvox/bandlimit/soup_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/winding_number.h>

#include <openvdb/openvdb.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;
using std::numbers::pi;

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// A bumpy ball of about so many triangles, each for itself and a little smaller, so that all of
// its edges are open.
Mesh shreds(int triangles) {
    const int rings = static_cast<int>(std::sqrt(triangles / 4.0));
    const auto point = [&](int i, int k) {
        const double polar = pi * (i + 0.02) / (rings + 0.04), angle = pi * k / rings;
        const double radius = 1 + 0.1 * std::sin(7 * polar) * std::cos(5 * angle);
        return radius * Vec3d(std::sin(polar) * std::cos(angle), -std::cos(polar),
                              std::sin(polar) * std::sin(angle));
    };
    Mesh mesh;
    const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
        const Vec3d middle = (a + b + c) / 3.0;
        const auto first = static_cast<openvdb::Index32>(mesh.points.size());
        for (const Vec3d& p : {a, b, c}) mesh.points.push_back(middle + 0.9 * (p - middle));
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    };
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < 2 * rings; ++k) {
            add(point(i, k), point(i + 1, k), point(i + 1, k + 1));
            add(point(i, k), point(i + 1, k + 1), point(i, k + 1));
        }
    }
    return mesh;
}

// Half of them anywhere in a box around, half near the surface.
std::vector<Vec3d> places(const Mesh& mesh, int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<> uniform(-1.3, 1.3);
    std::uniform_int_distribution<std::size_t> point(0, mesh.points.size() - 1);
    std::vector<Vec3d> found;
    for (int i = 0; i < count; ++i) {
        const Vec3d anywhere(uniform(random), uniform(random), uniform(random));
        found.push_back(i % 2 == 0 ? anywhere : mesh.points[point(random)] + 0.01 * anywhere);
    }
    return found;
}

struct Deviation {
    double largest = 0, rms = 0;
};

template <typename At>
Deviation deviation(const std::vector<Vec3d>& where, const std::vector<double>& exact,
                    const At& at) {
    Deviation found;
    for (std::size_t i = 0; i < where.size(); ++i) {
        const double difference = std::abs(at(where[i]) - exact[i]);
        found.largest = std::max(found.largest, difference);
        found.rms += difference * difference / static_cast<double>(where.size());
    }
    found.rms = std::sqrt(found.rms);
    return found;
}

void measureTree(const Folder& folder) {
    Table costs = folder.table("winding_number",
                               "triangles,build_seconds,microseconds,"
                               "exact_microseconds,largest,rms");
    Table groups = folder.table("winding_groups", "far_away,largest,rms");
    for (const int triangles : {1000, 10000, 100000, 1000000}) {
        const Mesh mesh = shreds(triangles);
        auto start = std::chrono::steady_clock::now();
        const WindingNumber winding(mesh);
        const double build = secondsSince(start);
        const std::vector<Vec3d> where = places(mesh, triangles < 1000000 ? 1000 : 200);
        start = std::chrono::steady_clock::now();
        std::vector<double> exact;
        for (const Vec3d& place : where) exact.push_back(winding.exactAt(place));
        const double each = secondsSince(start) / static_cast<double>(where.size());
        start = std::chrono::steady_clock::now();
        const Deviation found =
            deviation(where, exact, [&](const Vec3d& place) { return winding.at(place); });
        costs.add(mesh.triangles.size(), build,
                  1e6 * secondsSince(start) / static_cast<double>(where.size()), 1e6 * each,
                  found.largest, found.rms);
        if (triangles != 100000) continue;
        for (const double farAway : {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 6.0}) {
            WindingTerms terms;
            const Deviation by = deviation(where, exact, [&](const Vec3d& place) {
                winding.tree().collect({place, 0.0}, farAway, terms);
                return terms.at(place);
            });
            groups.add(farAway, by.largest, by.rms);
        }
    }
}

// Closed meshes, taken as soups: what the exact route makes of them is the truth.
void measureRows(const Folder& folder) {
    Table table = folder.table("winding_rows", "solid,voxels,rows,true_error,stated_error");
    for (const MeshSource& mesh : {chair(), propeller()}) {
        const Vec3d size = mesh.bounds().extents();
        const double longest = std::max({size.x(), size.y(), size.z()});
        for (const int voxels : {100, 200}) {
            DensityOptions density;
            density.voxelSize = longest / voxels;
            const DensityResult truth = surfaceToDensity(mesh, density);
            for (const int rows : {2, 4, 6, 8, 12}) {
                SoupDensityOptions options;
                options.density = density;
                options.rowsPerVoxel = rows;
                const DensityResult found = soupToDensity({mesh.name(), mesh.mesh(), {}}, options);
                table.add(mesh.name(), voxels, rows, largestDifference(*found.grid, *truth.grid),
                          found.metadata.samplingError);
            }
        }
    }
}

}  // namespace

void measureWinding(const Folder& folder) {
    openvdb::initialize();
    measureTree(folder);
    measureRows(folder);
}

}  // namespace bandvox::experiments
