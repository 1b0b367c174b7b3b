#include "outline/volumes/curve_places.h"

#include <bandvox/core/parallel.h>

#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

// Cells are looked at in cubes, which have a layer of nodes more than cells.
constexpr int kCells = 8, kNodes = kCells + 1;

// The cubes that blocks near the surface, or inside of it, are in.
std::vector<Coord> cubesOf(const SurfaceBlocks& blocks) {
    static_assert(kCells == 2 * SurfaceBlocks::kSide);
    std::vector<Coord> cubes;
    for (const SurfaceBlocks::Group& group : blocks.groups()) {
        const int side = group.side / 2;
        for (int n = 0; n < side * side * side; ++n) {
            const int i = n / (side * side), j = n / side % side, k = n % side;
            bool isThere = group.rows == nullptr;
            for (int b = 0; !isThere && b < 8; ++b) {
                const int x = 2 * i + b / 4, y = 2 * j + b / 2 % 2, z = 2 * k + b % 2;
                isThere = (group.rows[x] >> (8 * y + z) & 1U) != 0;
            }
            if (isThere) cubes.push_back(group.first.offsetBy(kCells * i, kCells * j, kCells * k));
        }
    }
    return cubes;
}

/// A place on an edge of the lattice where it passes through the surface.
struct EdgePlace {
    Vec3d at{0, 0, 0};
    double side = std::numeric_limits<double>::quiet_NaN();  // g there
};

/// Looks at one cube after another.
class CubeSearch {
  public:
    CubeSearch(const VolumeSurface& surface, const EquationsMaker& equations)
        : mIso(surface.object->threshold()),
          mNodes(surface.object->grid().tree()),
          mProbe(surface.object->probe()),
          mEquations(equations()),
          mEdges(3 * mValues.size()) {}

    void search(const Coord& cube, std::vector<Vec3d>& places) {
        if (!read(cube)) return;
        std::fill(mEdges.begin(), mEdges.end(), EdgePlace{});
        mCube = cube;
        for (int n = 0; n < kCells * kCells * kCells; ++n) {
            const Coord cell(n / (kCells * kCells), n / kCells % kCells, n % kCells);
            if (const auto place = placeIn(cell)) places.push_back(*place);
        }
    }

  private:
    static std::size_t nodeIndex(const Coord& node) {
        const int index = (node[0] * kNodes + node[1]) * kNodes + node[2];
        return static_cast<std::size_t>(index);
    }

    // The values of a cube; false if all are on one side of the surface.
    bool read(const Coord& cube) {
        // A constant cube among such ones is known by its neighbours.
        bool isConstant = true;
        bool isInside = false, isOutside = false;
        for (int n = 0; isConstant && n < 8; ++n) {
            const Coord at = cube.offsetBy(n / 4 * kCells, n / 2 % 2 * kCells, n % 2 * kCells);
            isConstant = mNodes.probeConstLeaf(at) == nullptr;
            if (isConstant) (mNodes.getValue(at) >= mIso ? isInside : isOutside) = true;
        }
        if (isConstant && isInside != isOutside) return false;
        isInside = isOutside = false;
        std::size_t k = 0;
        for (int x = 0; x < kNodes; ++x) {
            for (int y = 0; y < kNodes; ++y) {
                for (int z = 0; z < kNodes; ++z, ++k) {
                    mValues[k] = mNodes.getValue(cube.offsetBy(x, y, z)) - mIso;
                    (mValues[k] >= 0 ? isInside : isOutside) = true;
                }
            }
        }
        return isInside && isOutside;
    }

    const EdgePlace& placeOn(const Coord& node, int axis) {
        EdgePlace& edge = mEdges[3 * nodeIndex(node) + static_cast<std::size_t>(axis)];
        if (!std::isnan(edge.side)) return edge;
        Coord end = node;
        ++end[axis];
        const double a = mValues[nodeIndex(node)], b = mValues[nodeIndex(end)];
        edge.at = (mCube + node).asVec3d();
        const double begin = edge.at[axis];
        edge.at[axis] = begin + a / (a - b);
        // One step of Newton's method is enough to tell on which side of the curve it is.
        const DensityAt first = mProbe->evaluate(edge.at);
        const double slope = first.gradient[axis];
        if (slope != 0) {
            const double move = (mIso - first.value) / slope;
            edge.at[axis] = std::clamp(edge.at[axis] + move, begin, begin + 1);
        }
        edge.side = mEquations->side(edge.at);
        if (std::isnan(edge.side)) edge.side = 0;
        return edge;
    }

    // A place on a curve near a cell that it goes through.
    std::optional<Vec3d> placeIn(const Coord& cell) {
        std::array<const EdgePlace*, 12> edges{};
        std::size_t count = 0;
        bool isAbove = false, isBelow = false;
        for (int axis = 0; axis < 3; ++axis) {
            for (int n = 0; n < 4; ++n) {
                Coord node = cell;
                node[(axis + 1) % 3] += n % 2;
                node[(axis + 2) % 3] += n / 2;
                Coord end = node;
                ++end[axis];
                if ((mValues[nodeIndex(node)] >= 0) == (mValues[nodeIndex(end)] >= 0)) continue;
                const EdgePlace& edge = placeOn(node, axis);
                (edge.side >= 0 ? isAbove : isBelow) = true;
                edges[count++] = &edge;
            }
        }
        if (!isAbove || !isBelow) return std::nullopt;
        return placeBetween({edges.data(), count}, (mCube + cell).asVec3d() + Vec3d(0.5));
    }

    std::optional<Vec3d> placeBetween(std::span<const EdgePlace* const> edges,
                                      const Vec3d& middle) {
        const EdgePlace *above = nullptr, *below = nullptr;
        double nearest = std::numeric_limits<double>::infinity();
        for (const EdgePlace* a : edges) {
            for (const EdgePlace* b : edges) {
                if (!(a->side >= 0 && b->side < 0)) continue;
                const double apart = (a->at - b->at).length();
                if (apart >= nearest) continue;
                nearest = apart;
                above = a;
                below = b;
            }
        }
        const double share = above->side / (above->side - below->side);
        const Vec3d guess = above->at + share * (below->at - above->at);
        constexpr double kReach = 1.5;
        auto found = ontoCurve(*mEquations, guess, kReach);
        if (!found) found = halve(*above, *below);
        if (!found || (found->at - middle).length() > kReach) return std::nullopt;
        return found->at;
    }

    // From both sides along the surface.
    std::optional<SpacePoint> halve(const EdgePlace& above, const EdgePlace& below) {
        constexpr int kHalvings = 12;
        Vec3d a = above.at, b = below.at;
        for (int n = 0; n < kHalvings; ++n) {
            Vec3d middle = 0.5 * (a + b);
            for (int step = 0; step < 3; ++step) {
                const DensityAt density = mProbe->evaluate(middle);
                const double square = density.gradient.lengthSqr();
                if (!(square > 0)) return std::nullopt;
                middle += (mIso - density.value) / square * density.gradient;
            }
            if (!((middle - a).length() < 2)) return std::nullopt;
            (mEquations->side(middle) >= 0 ? a : b) = middle;
        }
        return ontoCurve(*mEquations, 0.5 * (a + b), 0.1);
    }

    double mIso;
    openvdb::tree::ValueAccessor<const openvdb::FloatTree, false> mNodes;
    std::unique_ptr<DensityProbe> mProbe;
    std::unique_ptr<CurveEquations> mEquations;
    Coord mCube;
    std::array<double, static_cast<std::size_t>(kNodes* kNodes* kNodes)> mValues{};
    std::vector<EdgePlace> mEdges;
};

}  // namespace

std::vector<Vec3d> curvePlaces(const VolumeSurface& surface, const EquationsMaker& equations,
                               Progress& progress) {
    constexpr std::size_t kCubesPerTask = 64;
    const std::vector<Coord> cubes = cubesOf(surface.object->blocks());
    std::vector<std::vector<Vec3d>> parts((cubes.size() + kCubesPerTask - 1) / kCubesPerTask);
    parallelFor(static_cast<std::int64_t>(parts.size()), [&](std::int64_t task) {
        progress.throwIfInterrupted();
        CubeSearch search(surface, equations);
        const std::size_t begin = static_cast<std::size_t>(task) * kCubesPerTask;
        const std::size_t end = std::min(begin + kCubesPerTask, cubes.size());
        for (std::size_t i = begin; i < end; ++i) {
            search.search(cubes[i], parts[static_cast<std::size_t>(task)]);
        }
    });
    std::vector<Vec3d> places;
    for (const auto& part : parts) places.insert(places.end(), part.begin(), part.end());
    return places;
}

}  // namespace bandvox
