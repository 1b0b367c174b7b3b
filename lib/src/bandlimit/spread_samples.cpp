#include "bandlimit/spread_samples.h"

#include "core/instruction_sets.h"

#include <cmath>

namespace bandvox {

namespace {

struct KernelPolynomials {
    const float* coefficients;
    int degree;
    int width;
};

// Horner's rule for all nodes along one axis at once. Returns the first node.
template <int kLanes>
[[gnu::always_inline]] inline int axisWeights(const KernelPolynomials& kernel, float x,
                                              float* weights) {
    const float left = x - 0.5F * static_cast<float>(kernel.width);
    const int truncated = static_cast<int>(left);  // left ≥ 0
    const int first = truncated + (static_cast<float>(truncated) < left ? 1 : 0);
    const float z = 2 * (static_cast<float>(first) - left) - 1;
    float sum[kLanes];
    for (int j = 0; j < kLanes; ++j) sum[j] = kernel.coefficients[j];
    for (int p = 1; p <= kernel.degree; ++p) {
        const float* row = kernel.coefficients + p * SpreadingKernel::kPaddedWidth;
        for (int j = 0; j < kLanes; ++j) sum[j] = sum[j] * z + row[j];
    }
    for (int j = 0; j < kLanes; ++j) weights[j] = sum[j];
    return first;
}

template <int kLanes>
[[gnu::always_inline]] inline void spread(std::span<const SurfaceSample> samples, float offset,
                                          const KernelPolynomials& kernel,
                                          const SpreadLattice& lattice) {
    alignas(64) float wx[kLanes], wy[kLanes], wz[kLanes];
    for (const SurfaceSample& sample : samples) {
        const float weight = -sample.areaVector.x();
        if (weight == 0) continue;
        const int x = axisWeights<kLanes>(kernel, sample.position.x() + offset, wx);
        const int y = axisWeights<kLanes>(kernel, sample.position.y() + offset, wy);
        const int z = axisWeights<kLanes>(kernel, sample.position.z() + offset, wz);
        for (int i = 0; i < kernel.width; ++i) {
            float* row =
                lattice.nodes +
                (static_cast<std::ptrdiff_t>(x + i) * lattice.yCount + y) * lattice.zStride + z;
            const float plane = weight * wx[i];
            for (int j = 0; j < kernel.width; ++j, row += lattice.zStride) {
                const float line = plane * wy[j];
                for (int k = 0; k < kLanes; ++k) row[k] += line * wz[k];
            }
        }
    }
}

// So many floats in a row, added to others at once: of a loop over sixteen products the compiler
// makes as many single ones.
template <int kCount>
struct FloatRow {
    typedef float Type
        __attribute__((vector_size(kCount * sizeof(float)), aligned(alignof(float)), may_alias));
};

// The two weights go into the rows, so that one row of products serves both sums.
template <int kLanes>
[[gnu::always_inline]] inline void spreadPairs(std::span<const PairedSample> samples, float offset,
                                               const KernelPolynomials& kernel,
                                               const SpreadLattice& lattice) {
    alignas(64) float wx[kLanes], wy[kLanes], wz[kLanes];
    using Row = typename FloatRow<2 * kLanes>::Type;
    Row both{};
    for (const PairedSample& sample : samples) {
        const int x = axisWeights<kLanes>(kernel, sample.position.x() + offset, wx);
        const int y = axisWeights<kLanes>(kernel, sample.position.y() + offset, wy);
        const int z = axisWeights<kLanes>(kernel, sample.position.z() + offset, wz);
        for (int k = 0; k < kLanes; ++k) {
            both[2 * k] = sample.weights[0] * wz[k];
            both[2 * k + 1] = sample.weights[1] * wz[k];
        }
        for (int i = 0; i < kernel.width; ++i) {
            float* row =
                lattice.nodes +
                2 * ((static_cast<std::ptrdiff_t>(x + i) * lattice.yCount + y) * lattice.zStride +
                     z);
            for (int j = 0; j < kernel.width; ++j, row += 2 * lattice.zStride) {
                const float line = wx[i] * wy[j];
                *reinterpret_cast<Row*>(row) += line * both;
            }
        }
    }
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void spreadNarrow(std::span<const SurfaceSample> samples, float offset,
                  const KernelPolynomials& kernel, const SpreadLattice& lattice) {
    spread<8>(samples, offset, kernel, lattice);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void spreadWide(std::span<const SurfaceSample> samples, float offset,
                const KernelPolynomials& kernel, const SpreadLattice& lattice) {
    spread<16>(samples, offset, kernel, lattice);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void spreadNarrowPairs(std::span<const PairedSample> samples, float offset,
                       const KernelPolynomials& kernel, const SpreadLattice& lattice) {
    spreadPairs<8>(samples, offset, kernel, lattice);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void spreadWidePairs(std::span<const PairedSample> samples, float offset,
                     const KernelPolynomials& kernel, const SpreadLattice& lattice) {
    spreadPairs<16>(samples, offset, kernel, lattice);
}

KernelPolynomials polynomialsOf(const SpreadingKernel& kernel) {
    return {kernel.polynomials().data(), kernel.polynomialDegree(), kernel.width()};
}

}  // namespace

void spreadSamples(std::span<const SurfaceSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice) {
    const auto spreadAll = kernel.paddedWidth() == 8 ? spreadNarrow : spreadWide;
    spreadAll(samples, offset, polynomialsOf(kernel), lattice);
}

void spreadSamples(std::span<const PairedSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice) {
    const auto spreadAll = kernel.paddedWidth() == 8 ? spreadNarrowPairs : spreadWidePairs;
    spreadAll(samples, offset, polynomialsOf(kernel), lattice);
}

}  // namespace bandvox
