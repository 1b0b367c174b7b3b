#include "core/words.h"

#include <bandvox/grid/same_lattice.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {

namespace {

constexpr double kSameLattice = 1e-6;

openvdb::Mat4d matrixOfLattice(const openvdb::math::Transform& transform) {
    return transform.baseMap()->getAffineMap()->getMat4();
}

// How the voxels of two lattices lie to each other.
struct LatticeRelation {
    bool areLinear = true;
    bool haveSameSteps = true;
    openvdb::Vec3d offset{0, 0, 0};  // of the first's voxel 0, in voxels of the other
    bool isWhole = true;
};

LatticeRelation relationOf(const openvdb::math::Transform& first,
                           const openvdb::math::Transform& other) {
    LatticeRelation relation;
    relation.areLinear = first.isLinear() && other.isLinear();
    if (!relation.areLinear) return relation;
    const openvdb::Mat4d map = matrixOfLattice(first) * matrixOfLattice(other).inverse();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            const double expected = row == column ? 1 : 0;
            // What is not finite is not the same.
            if (!(std::abs(map(row, column) - expected) <= kSameLattice)) {
                relation.haveSameSteps = false;
            }
        }
        const double offset = map(3, row);
        relation.offset[row] = offset;
        const double allowed = kSameLattice * std::max(1.0, std::abs(offset));
        constexpr double kFarthest = 0.25 * std::numeric_limits<int>::max();
        if (!(std::abs(offset - std::round(offset)) <= allowed && std::abs(offset) < kFarthest)) {
            relation.isWhole = false;
        }
    }
    return relation;
}

std::string listed(const openvdb::Vec3d& v) {
    std::string text = "(";
    for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0) text += ", ";
        text += inShort(v[axis]);
    }
    return text + ")";
}

// How far an axis of a lattice turns in the other, degrees, at most.
double largestTurn(const openvdb::math::Transform& first, const openvdb::math::Transform& other) {
    const openvdb::Mat4d a = matrixOfLattice(first), b = matrixOfLattice(other);
    double largest = 0;
    for (int row = 0; row < 3; ++row) {
        const openvdb::Vec3d u(a(row, 0), a(row, 1), a(row, 2));
        const openvdb::Vec3d v(b(row, 0), b(row, 1), b(row, 2));
        largest = std::max(largest, std::atan2(u.cross(v).length(), u.dot(v)));
    }
    return largest * 180 / openvdb::math::pi<double>();
}

}  // namespace

std::optional<openvdb::Coord> wholeVoxelOffset(const openvdb::math::Transform& first,
                                               const openvdb::math::Transform& other) {
    const LatticeRelation relation = relationOf(first, other);
    if (!relation.areLinear || !relation.haveSameSteps || !relation.isWhole) return std::nullopt;
    return openvdb::Coord::round(relation.offset);
}

std::string latticeDifference(const openvdb::math::Transform& first,
                              const openvdb::math::Transform& other) {
    const LatticeRelation relation = relationOf(first, other);
    if (!relation.areLinear) {
        return "their transforms are of types " + first.mapType() + " and " + other.mapType() +
               ", of which one is not linear";
    }
    if (!relation.haveSameSteps) {
        std::string text = "their voxels have sides " + listed(first.voxelSize());
        text += " and " + listed(other.voxelSize());
        constexpr double kLeastTurn = 1e-5;  // degrees
        const double turn = largestTurn(first, other);
        if (turn > kLeastTurn) {
            text += ", and axes that are turned by up to " + inShort(turn) + " degrees";
        }
        return text;
    }
    if (!relation.isWhole) {
        return "they are " + listed(relation.offset) +
               " voxels from each other, which are not whole numbers";
    }
    return {};
}

}  // namespace bandvox
