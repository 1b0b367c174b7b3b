#include <bandvox/resample/cubic_lattice.h>
#include <bandvox/resample/resample_grid.h>

#include <cmath>

namespace bandvox {

namespace {

// How far sides and angles of voxels may be from those of cubes, relative.
constexpr double kCubeTolerance = 1e-6;

}  // namespace

bool hasCubicVoxels(const openvdb::math::Transform& lattice) {
    if (!lattice.isLinear()) return false;
    const auto map = lattice.baseMap();
    const openvdb::Vec3d axes[] = {map->applyJacobian({1, 0, 0}), map->applyJacobian({0, 1, 0}),
                                   map->applyJacobian({0, 0, 1})};
    const double square = axes[0].lengthSqr();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j <= i; ++j) {
            const double expected = i == j ? square : 0;
            if (std::abs(axes[i].dot(axes[j]) - expected) > kCubeTolerance * square) return false;
        }
    }
    return true;
}

openvdb::math::Transform::Ptr cubicLattice(const openvdb::GridBase& grid, double side) {
    openvdb::Mat4d matrix = uniformLattice(grid, side)->baseMap()->getAffineMap()->getMat4();
    openvdb::Vec3d axes[3];
    for (int i = 0; i < 3; ++i) {
        axes[i] = {matrix(i, 0), matrix(i, 1), matrix(i, 2)};
        for (int j = 0; j < i; ++j) axes[i] -= axes[i].dot(axes[j]) / (side * side) * axes[j];
        axes[i] *= side / axes[i].length();
        for (int k = 0; k < 3; ++k) matrix(i, k) = axes[i][k];
    }
    return openvdb::math::Transform::createLinearTransform(matrix);
}

}  // namespace bandvox
