#include "resample/lattice_map.h"

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// Steps are whole if they are so within this.
constexpr double kWhole = 1e-9;

openvdb::Mat4d matrixOf(const openvdb::math::Transform& transform) {
    return transform.baseMap()->getAffineMap()->getMat4();
}

bool isWhole(double number) {
    return std::abs(number - std::round(number)) <= kWhole * std::max(1.0, std::abs(number));
}

openvdb::BBoxd boxOf(const openvdb::BBoxd& box, const openvdb::Mat4d& matrix) {
    openvdb::BBoxd result;
    for (int corner = 0; corner < 8; ++corner) {
        openvdb::Vec3d place;
        for (int axis = 0; axis < 3; ++axis) {
            place[axis] = (corner >> axis & 1) != 0 ? box.max()[axis] : box.min()[axis];
        }
        result.expand(matrix.transform(place));
    }
    return result;
}

}  // namespace

LatticeMap::LatticeMap(const openvdb::math::Transform& source,
                       const openvdb::math::Transform& target)
    : mToSource(matrixOf(target) * matrixOf(source).inverse()), mToTarget(mToSource.inverse()) {
    // OpenVDB's matrices act on rows: row j is the step along the target's axis j. |Aᵀk|² is a
    // quadratic form, whose eigenvalues are squares of steps.
    const openvdb::Mat3d steps = mToSource.getMat3();
    const openvdb::Mat3d square = steps.transpose() * steps;
    openvdb::Mat3d directions;
    openvdb::Vec3d squares;
    openvdb::math::diagonalizeSymmetricMatrix(square, directions, squares);
    mLargestStep = std::sqrt(std::max({squares[0], squares[1], squares[2]}));
    openvdb::Mat3d limited = openvdb::Mat3d::zero();
    for (int axis = 0; axis < 3; ++axis) {
        squares[axis] = std::max(squares[axis], 1.0);
        limited(axis, axis) = squares[axis];
    }
    mSquare = directions * limited * directions.transpose();
    mCoarsest = std::sqrt(std::max({squares[0], squares[1], squares[2]}));
    mFinest = std::sqrt(std::min({squares[0], squares[1], squares[2]}));

    mIsDiagonal = true;
    for (int row = 0; row < 3; ++row) {
        const double length = steps.row(row).length();
        for (int column = 0; column < 3; ++column) {
            const bool isSmall = std::abs(steps(row, column)) <= kWhole * length;
            mIsDiagonal = mIsDiagonal && (row == column || isSmall);
        }
    }
    mIsAligned = true;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column) {
            mIsAligned = mIsAligned && isWhole(mToSource(row, column));
        }
    }
}

openvdb::BBoxd LatticeMap::toSource(const openvdb::BBoxd& target) const {
    return boxOf(target, mToSource);
}

openvdb::BBoxd LatticeMap::toTarget(const openvdb::BBoxd& source) const {
    return boxOf(source, mToTarget);
}

double LatticeMap::frequency(const openvdb::Vec3d& k) const {
    return std::sqrt(std::max(k.dot(mSquare * k), 0.0));
}

}  // namespace bandvox
