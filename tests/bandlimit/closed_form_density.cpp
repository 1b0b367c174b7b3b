#include "bandlimit/closed_form_density.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace bandvox {

namespace {

constexpr double kPi = std::numbers::pi;

double sinc(double x) {
    return std::abs(x) < 1e-6 ? 1 - x * x / 6 : std::sin(x) / x;
}

}  // namespace

ClosedFormDensity::ClosedFormDensity(int side, const ExponentialFilter& filter,
                                     const Transform& transform)
    : mSide(side), mValues(static_cast<std::size_t>(side) * side * side) {
    const int half = side / 2 + 1;
    const std::size_t count = static_cast<std::size_t>(side) * side * half;
    fftw_complex* series = fftw_alloc_complex(count);
    const auto signedIndex = [side](int i) { return i < side / 2 ? i : i - side; };
    std::size_t at = 0;
    for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
            for (int z = 0; z < half; ++z, ++at) {
                const openvdb::Vec3d k(static_cast<double>(signedIndex(x)) / side,
                                       static_cast<double>(signedIndex(y)) / side,
                                       static_cast<double>(z) / side);
                const bool isNyquist = 2 * x == side || 2 * y == side || 2 * z == side;
                const std::complex<double> value =
                    isNyquist ? 0 : transform(k) * filter(k.length()) / std::pow(side, 3);
                series[at][0] = value.real();
                series[at][1] = value.imag();
            }
        }
    }
    fftw_plan plan = fftw_plan_dft_c2r_3d(side, side, side, series, mValues.data(), FFTW_ESTIMATE);
    fftw_execute(plan);
    fftw_destroy_plan(plan);
    fftw_free(series);
}

double ClosedFormDensity::operator()(const openvdb::Coord& voxel) const {
    const auto wrap = [this](int i) { return static_cast<std::size_t>((i + mSide) % mSide); };
    return mValues[(wrap(voxel.x()) * mSide + wrap(voxel.y())) * mSide + wrap(voxel.z())];
}

double ClosedFormDensity::largestError(const openvdb::FloatGrid& grid) const {
    const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
    const int half = mSide / 2;
    double largest = 0;
    for (int x = -half; x < half; ++x) {
        for (int y = -half; y < half; ++y) {
            for (int z = -half; z < half; ++z) {
                const openvdb::Coord voxel(x, y, z);
                const double error = std::abs(accessor.getValue(voxel) - (*this)(voxel));
                largest = std::max(largest, error);
            }
        }
    }
    return largest;
}

ClosedFormDensity::Transform TurnedBox::transform() const {
    const openvdb::Mat3R back = rotation.transpose();
    return [*this, back](const openvdb::Vec3d& k) {
        const openvdb::Vec3d turned = back * k;
        double value = 1;
        for (int axis = 0; axis < 3; ++axis) {
            value *= 2 * half[axis] * sinc(2 * kPi * turned[axis] * half[axis]);
        }
        return std::polar(value, -2 * kPi * k.dot(center));
    };
}

Mesh TurnedBox::mesh(double voxelSize) const {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        const openvdb::Vec3d local((corner & 1) != 0 ? half.x() : -half.x(),
                                   (corner & 2) != 0 ? half.y() : -half.y(),
                                   (corner & 4) != 0 ? half.z() : -half.z());
        mesh.points.push_back((rotation * local + center) * voxelSize);
    }
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : kFaces) {
        mesh.triangles.emplace_back(face[0], face[1], face[2]);
        mesh.triangles.emplace_back(face[0], face[2], face[3]);
    }
    return mesh;
}

ClosedFormDensity::Transform ballTransform(double radius, const openvdb::Vec3d& center) {
    return [=](const openvdb::Vec3d& k) {
        const double q = 2 * kPi * k.length() * radius;
        const double volume = 4.0 / 3 * kPi * std::pow(radius, 3);
        const double shape =
            q < 1e-3 ? 1 - q * q / 10 : 3 * (std::sin(q) - q * std::cos(q)) / (q * q * q);
        return std::polar(1.0, -2 * kPi * k.dot(center)) * (volume * shape);
    };
}

Mesh ballMesh(double radius, const openvdb::Vec3d& center, int levels) {
    const double golden = std::numbers::phi;
    std::vector<openvdb::Vec3d> points = {{-1, golden, 0},  {1, golden, 0},   {-1, -golden, 0},
                                          {1, -golden, 0},  {0, -1, golden},  {0, 1, golden},
                                          {0, -1, -golden}, {0, 1, -golden},  {golden, 0, -1},
                                          {golden, 0, 1},   {-golden, 0, -1}, {-golden, 0, 1}};
    for (openvdb::Vec3d& point : points) point.normalize();
    std::vector<openvdb::Vec3I> triangles = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (isNew) points.push_back((points[a] + points[b]).unit());
            return found->second;
        };
        std::vector<openvdb::Vec3I> finer;
        for (const openvdb::Vec3I& t : triangles) {
            const std::uint32_t a = middle(t[0], t[1]);
            const std::uint32_t b = middle(t[1], t[2]);
            const std::uint32_t c = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
        }
        triangles = std::move(finer);
    }
    double volume = 0;
    for (const openvdb::Vec3I& t : triangles) {
        volume += points[t[0]].dot(points[t[1]].cross(points[t[2]])) / 6;
    }
    const double scale = radius * std::cbrt(4.0 / 3 * kPi / volume);
    Mesh mesh;
    for (const openvdb::Vec3d& point : points) mesh.points.push_back(center + point * scale);
    mesh.triangles = std::move(triangles);
    return mesh;
}

openvdb::Mat3R someRotation() {
    const auto about = [](const openvdb::Vec3d& axis, double angle) {
        openvdb::Mat3R matrix;
        matrix.setToRotation(axis, angle);
        return matrix;
    };
    return about({0, 0, 1}, 0.4) * about({0, 1, 0}, 0.3) * about({1, 0, 0}, 0.7);
}

}  // namespace bandvox
