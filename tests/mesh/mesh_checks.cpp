#include "mesh/mesh_checks.h"

#include "source/triangle_distance.h"

#include <bandvox/source/unite_shells.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <unordered_map>
#include <vector>

namespace bandvox::mesh_test {

using openvdb::Vec3d;

namespace {

// The triangles' third corner by directed edge.
using EdgeMap = std::unordered_map<std::uint64_t, std::uint32_t>;

std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t(from) << 32 | to;
}

}  // namespace

std::string flaw(const Mesh& mesh) {
    EdgeMap next;
    next.reserve(3 * mesh.triangles.size());
    std::vector<std::uint32_t> uses(mesh.points.size(), 0);
    std::vector<std::uint32_t> some(mesh.points.size(), 0);
    for (const openvdb::Vec3I& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            if (a >= mesh.points.size()) return "index " + std::to_string(a) + " out of range";
            if (a == b) return "triangle with a corner twice";
            if (!next.emplace(key(a, b), t[(k + 2) % 3]).second) {
                return "edge " + std::to_string(a) + " " + std::to_string(b) + " twice";
            }
            ++uses[a];
            some[a] = b;
        }
    }
    for (const auto& [edge, apex] : next) {
        if (!next.contains(edge << 32 | edge >> 32)) return "edge without its opposite";
    }
    for (std::uint32_t point = 0; point < mesh.points.size(); ++point) {
        if (uses[point] == 0) return "point " + std::to_string(point) + " without triangles";
        std::uint32_t around = some[point];
        std::uint32_t steps = 0;
        do {
            around = next.at(key(point, around));
            ++steps;
        } while (around != some[point] && steps <= uses[point]);
        if (steps != uses[point]) {
            return "point " + std::to_string(point) + " with more than one fan";
        }
    }
    return {};
}

double enclosedVolume(const Mesh& mesh) {
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d a = mesh.points[t[0]] - mesh.points[0];
        sum +=
            a.dot((mesh.points[t[1]] - mesh.points[0]).cross(mesh.points[t[2]] - mesh.points[0]));
    }
    return sum / 6;
}

long eulerNumber(const Mesh& mesh) {
    const auto triangles = static_cast<long>(mesh.triangles.size());
    return static_cast<long>(mesh.points.size()) - triangles / 2;
}

std::size_t pieces(const Mesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.points.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const openvdb::Vec3I& t : mesh.triangles) {
        parent[root(t[1])] = root(t[0]);
        parent[root(t[2])] = root(t[0]);
    }
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < parent.size(); ++i) count += parent[i] == i ? 1 : 0;
    return count;
}

MeshDistance::MeshDistance(const Mesh& mesh) : mMesh(mesh) {
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d center = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
        double radius = 0;
        for (int k = 0; k < 3; ++k) {
            radius = std::max(radius, (mesh.points[t[k]] - center).length());
        }
        mBalls.push_back({center, radius});
    }
}

double MeshDistance::operator()(const Vec3d& place) const {
    const auto distance = [&](std::size_t i) {
        const openvdb::Vec3I& t = mMesh.triangles[i];
        return distanceToTriangle(place,
                                  {mMesh.points[t[0]], mMesh.points[t[1]], mMesh.points[t[2]]});
    };
    double nearest = distance(mLast);
    for (std::size_t i = 0; i < mBalls.size(); ++i) {
        const double reach = nearest + mBalls[i].radius;
        if ((place - mBalls[i].center).lengthSqr() > reach * reach) continue;
        const double found = distance(i);
        if (found >= nearest) continue;
        nearest = found;
        mLast = i;
    }
    return nearest;
}

std::size_t meetings(const Mesh& mesh) {
    return uniteShells(mesh).report.meetings;
}

ErrorKind kindOf(const std::function<void()>& run) {
    try {
        run();
    } catch (const Error& error) {
        return error.kind();
    }
    return ErrorKind::Interrupted;
}

openvdb::FloatGrid::Ptr sampled(int side, const std::function<double(const Vec3d&)>& f) {
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    const auto box = openvdb::CoordBBox(openvdb::Coord(-side), openvdb::Coord(side));
    for (auto at = box.begin(); at; ++at) {
        accessor.setValue(*at, static_cast<float>(f((*at).asVec3d())));
    }
    return grid;
}

RandomWaves::RandomWaves(unsigned seed, double highest, double reach) : mReach(reach) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    while (mWaves.size() < 60) {
        const Vec3d direction(uniform(random), uniform(random), uniform(random));
        if (direction.length() > 1) continue;
        mWaves.push_back({highest * direction, std::numbers::pi * uniform(random)});
    }
}

double RandomWaves::operator()(const Vec3d& index) const {
    double sum = 0;
    for (const Wave& wave : mWaves) {
        sum += std::cos(2 * std::numbers::pi * wave.frequency.dot(index) + wave.phase);
    }
    const double window = std::exp(-index.lengthSqr() / (mReach * mReach));
    return window * sum / std::sqrt(0.5 * static_cast<double>(mWaves.size()));
}

}  // namespace bandvox::mesh_test
