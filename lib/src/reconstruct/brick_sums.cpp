#include "reconstruct/brick_sums.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"
#include "spectral/kernel_polynomials.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace bandvox {

namespace {

// Sums over the last axis go on in so many parts, whatever the instruction set.
constexpr int kParts = 4;

// The weights of the nodes around a place along one axis: of the value, and of the first and second
// derivatives, as many as are asked for.
template <int kLanes, int kOrders>
struct AxisWeights {
    int first;
    alignas(64) std::array<std::array<float, kLanes>, kOrders> of;
};

template <int kLanes, int kOrders>
[[gnu::always_inline]] inline AxisWeights<kLanes, kOrders> axisWeights(
    const SpreadingKernel& kernel, double local) {
    // Split off the whole voxels first, so that a float holds the rest exactly enough.
    const double whole = std::floor(local);
    const NodePlace place = placeOfNodes(kernel.width(), static_cast<float>(local - whole));
    AxisWeights<kLanes, kOrders> axis;
    axis.first = static_cast<int>(whole) + place.first - firstNode(kernel);
    for (int order = 0; order < kOrders; ++order) {
        evaluateNodes<kLanes>(kernel.polynomials(order).data(), kernel.polynomialDegree() - order,
                              place.z, axis.of[order].data());
    }
    return axis;
}

template <int kLanes, int kOrders>
struct PlaceWeights {
    std::array<AxisWeights<kLanes, kOrders>, 3> axes;
    const float* corner;  // the coefficient of the first node
};

template <int kLanes, int kOrders>
[[gnu::always_inline]] inline PlaceWeights<kLanes, kOrders> placeWeights(
    const BrickNodes& brick, const SpreadingKernel& kernel, const openvdb::Vec3d& local) {
    PlaceWeights<kLanes, kOrders> place;
    for (int a = 0; a < 3; ++a) place.axes[a] = axisWeights<kLanes, kOrders>(kernel, local[a]);
    const std::size_t row =
        static_cast<std::size_t>(place.axes[0].first) * brick.nodes + place.axes[1].first;
    place.corner = brick.coefficients + row * brick.pitch + place.axes[2].first;
    return place;
}

template <int kLanes>
[[gnu::always_inline]] inline double dot(const Lanes<kLanes>& a, const float* b) {
    Lanes<kLanes> product;
    loadLanes<kLanes>(b, product);
    product *= a;
    double parts[kParts] = {};
    for (int l = 0; l < kLanes; l += kParts) {
        for (int p = 0; p < kParts; ++p) parts[p] += product[l + p];
    }
    return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

template <int kLanes>
[[gnu::always_inline]] inline double valueOf(const BrickNodes& brick, const SpreadingKernel& kernel,
                                             const openvdb::Vec3d& local) {
    const auto place = placeWeights<kLanes, 1>(brick, kernel, local);
    Lanes<kLanes> sum{}, row;
    for (int i = 0; i < kernel.width(); ++i) {
        const float* plane = place.corner + static_cast<std::size_t>(i) * brick.nodes * brick.pitch;
        Lanes<kLanes> inPlane{};
        for (int j = 0; j < kernel.width(); ++j) {
            loadLanes<kLanes>(plane + j * brick.pitch, row);
            inPlane += place.axes[1].of[0][j] * row;
        }
        sum += place.axes[0].of[0][i] * inPlane;
    }
    return dot<kLanes>(sum, place.axes[2].of[0].data());
}

template <int kLanes>
[[gnu::always_inline]] inline DensityAt gradientOf(const BrickNodes& brick,
                                                   const SpreadingKernel& kernel,
                                                   const openvdb::Vec3d& local) {
    const auto place = placeWeights<kLanes, 2>(brick, kernel, local);
    const auto& [x, y, z] = place.axes;
    Lanes<kLanes> sum{}, sumX{}, sumY{}, row;
    for (int i = 0; i < kernel.width(); ++i) {
        const float* plane = place.corner + static_cast<std::size_t>(i) * brick.nodes * brick.pitch;
        Lanes<kLanes> inPlane{}, inPlaneY{};
        for (int j = 0; j < kernel.width(); ++j) {
            loadLanes<kLanes>(plane + j * brick.pitch, row);
            inPlane += y.of[0][j] * row;
            inPlaneY += y.of[1][j] * row;
        }
        sum += x.of[0][i] * inPlane;
        sumX += x.of[1][i] * inPlane;
        sumY += x.of[0][i] * inPlaneY;
    }
    return {dot<kLanes>(sum, z.of[0].data()),
            {dot<kLanes>(sumX, z.of[0].data()), dot<kLanes>(sumY, z.of[0].data()),
             dot<kLanes>(sum, z.of[1].data())}};
}

template <int kLanes>
[[gnu::always_inline]] inline DensityExpansion hessianOf(const BrickNodes& brick,
                                                         const SpreadingKernel& kernel,
                                                         const openvdb::Vec3d& local) {
    const auto place = placeWeights<kLanes, 3>(brick, kernel, local);
    const auto& x = place.axes[0];
    const auto& y = place.axes[1];
    const auto& z = place.axes[2];
    // Sums over x and y by the orders of their derivatives.
    Lanes<kLanes> sum[3][3] = {}, row;
    for (int i = 0; i < kernel.width(); ++i) {
        const float* plane = place.corner + static_cast<std::size_t>(i) * brick.nodes * brick.pitch;
        Lanes<kLanes> inPlane[3] = {};
        for (int j = 0; j < kernel.width(); ++j) {
            loadLanes<kLanes>(plane + j * brick.pitch, row);
            for (int b = 0; b < 3; ++b) inPlane[b] += y.of[b][j] * row;
        }
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; a + b < 3; ++b) sum[a][b] += x.of[a][i] * inPlane[b];
        }
    }
    const auto derivative = [&](int a, int b, int c) {
        return dot<kLanes>(sum[a][b], z.of[c].data());
    };
    const double xy = derivative(1, 1, 0), xz = derivative(1, 0, 1), yz = derivative(0, 1, 1);
    return {derivative(0, 0, 0),
            {derivative(1, 0, 0), derivative(0, 1, 0), derivative(0, 0, 1)},
            {derivative(2, 0, 0), xy, xz,  //
             xy, derivative(0, 2, 0), yz,  //
             xz, yz, derivative(0, 0, 2)}};
}

}  // namespace

NodeWeights nodeWeights(const SpreadingKernel& kernel, double local) {
    constexpr int kLanes = SpreadingKernel::kPaddedWidth;
    const auto axis = axisWeights<kLanes, 1>(kernel, local);
    return {axis.first, axis.of[0]};
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
double sumValue(const BrickNodes& brick, const SpreadingKernel& kernel,
                const openvdb::Vec3d& local) {
    return kernel.paddedWidth() == 8 ? valueOf<8>(brick, kernel, local)
                                     : valueOf<16>(brick, kernel, local);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
DensityAt sumGradient(const BrickNodes& brick, const SpreadingKernel& kernel,
                      const openvdb::Vec3d& local) {
    return kernel.paddedWidth() == 8 ? gradientOf<8>(brick, kernel, local)
                                     : gradientOf<16>(brick, kernel, local);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
DensityExpansion sumHessian(const BrickNodes& brick, const SpreadingKernel& kernel,
                            const openvdb::Vec3d& local) {
    return kernel.paddedWidth() == 8 ? hessianOf<8>(brick, kernel, local)
                                     : hessianOf<16>(brick, kernel, local);
}

}  // namespace bandvox
