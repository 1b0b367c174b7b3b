#include "reconstruct/random_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace bandvox::reconstruct_test {

using openvdb::Vec3d;
using Complex = std::complex<double>;

namespace {

constexpr double kPi = std::numbers::pi;

// exp(2πi k x / N) for each wave along an axis, and its first two derivatives.
template <int kWaves>
struct AxisWaves {
    std::array<Complex, kWaves> of[3];

    AxisWaves(double x, int period) {
        for (int i = 0; i < kWaves; ++i) {
            const double turn = 2 * kPi * (i - kWaves / 2) / period;
            of[0][i] = std::polar(1.0, turn * x);
            of[1][i] = Complex(0, turn) * of[0][i];
            of[2][i] = -turn * turn * of[0][i];
        }
    }
};

}  // namespace

RandomLattice::RandomLattice(const ExponentialFilter& filter, double mean, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int x = 0; x < kWaves; ++x) {
        for (int y = 0; y < kWaves; ++y) {
            for (int z = 0; z < kWaves; ++z) {
                const Vec3d k = Vec3d(x, y, z) - Vec3d(kWaves / 2);
                const double real = normal(random), imaginary = normal(random);
                mAmplitudes.push_back(filter(k.length() / kPeriod) * Complex(real, imaginary));
            }
        }
    }
    Complex& constant = mAmplitudes[mAmplitudes.size() / 2];
    constant = 0;
    double highest = 0;
    for (const double value : nodes()) highest = std::max(highest, std::abs(value));
    for (Complex& amplitude : mAmplitudes) amplitude *= (1 - mean) / highest;
    constant = mean;
}

DensityExpansion RandomLattice::operator()(const Vec3d& place) const {
    const AxisWaves<kWaves> x(place[0], kPeriod), y(place[1], kPeriod), z(place[2], kPeriod);
    // Sums by the orders of the derivatives along x, y, z.
    Complex sum[3][3][3] = {};
    const Complex* row = mAmplitudes.data();
    for (int i = 0; i < kWaves; ++i) {
        Complex inPlane[3][3] = {};
        for (int j = 0; j < kWaves; ++j, row += kWaves) {
            Complex inRow[3] = {};
            for (int l = 0; l < kWaves; ++l) {
                for (int c = 0; c < 3; ++c) inRow[c] += row[l] * z.of[c][l];
            }
            for (int b = 0; b < 3; ++b) {
                for (int c = 0; b + c < 3; ++c) inPlane[b][c] += y.of[b][j] * inRow[c];
            }
        }
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; a + b < 3; ++b) {
                for (int c = 0; a + b + c < 3; ++c) sum[a][b][c] += x.of[a][i] * inPlane[b][c];
            }
        }
    }
    const auto at = [&](int a, int b, int c) { return sum[a][b][c].real(); };
    return {at(0, 0, 0),
            {at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)},
            {at(2, 0, 0), at(1, 1, 0), at(1, 0, 1),  //
             at(1, 1, 0), at(0, 2, 0), at(0, 1, 1),  //
             at(1, 0, 1), at(0, 1, 1), at(0, 0, 2)}};
}

// The same sum at all nodes, axis by axis.
std::vector<double> RandomLattice::nodes() const {
    std::vector<Complex> from = mAmplitudes;
    int sides[3] = {kWaves, kWaves, kWaves};
    for (int axis = 0; axis < 3; ++axis) {
        const int before = axis == 0 ? 1 : axis == 1 ? sides[0] : sides[0] * sides[1];
        const int after = axis == 0 ? sides[1] * sides[2] : axis == 1 ? sides[2] : 1;
        std::vector<Complex> to(static_cast<std::size_t>(before) * kPeriod * after);
        for (int node = 0; node < kPeriod; ++node) {
            const AxisWaves<kWaves> waves(node, kPeriod);
            for (int b = 0; b < before; ++b) {
                Complex* out = &to[(static_cast<std::size_t>(b) * kPeriod + node) * after];
                const Complex* in = &from[static_cast<std::size_t>(b) * kWaves * after];
                for (int w = 0; w < kWaves; ++w, in += after) {
                    for (int a = 0; a < after; ++a) out[a] += waves.of[0][w] * in[a];
                }
            }
        }
        sides[axis] = kPeriod;
        from = std::move(to);
    }
    std::vector<double> values;
    values.reserve(from.size());
    for (const Complex& value : from) values.push_back(value.real());
    return values;
}

openvdb::FloatGrid::Ptr RandomLattice::grid(int halo) const {
    const std::vector<double> values = nodes();
    auto grid = openvdb::FloatGrid::create(0);
    auto accessor = grid->getAccessor();
    const openvdb::CoordBBox box(openvdb::Coord(-halo), openvdb::Coord(kPeriod + halo - 1));
    for (auto voxel = box.begin(); voxel; ++voxel) {
        std::size_t node = 0;
        for (int axis = 0; axis < 3; ++axis) {
            node = node * kPeriod + ((*voxel)[axis] % kPeriod + kPeriod) % kPeriod;
        }
        accessor.setValue(*voxel, static_cast<float>(values[node]));
    }
    return grid;
}

}  // namespace bandvox::reconstruct_test
