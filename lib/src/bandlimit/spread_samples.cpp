#include "bandlimit/spread_samples.h"

#include "core/instruction_sets.h"
#include "core/lanes.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

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

// So many floats in a row, added to others at once: of a loop over sixteen products the compiler
// makes as many single ones.
template <int kCount>
struct FloatRow {
    typedef float Type
        __attribute__((vector_size(kCount * sizeof(float)), aligned(alignof(float)), may_alias));
};

// Samples that are worked on together, each in a lane of its own.
constexpr int kTogether = 8;
using Floats = Lanes<kTogether>;
typedef int Ints __attribute__((vector_size(kTogether * sizeof(int))));

struct SampleBlock {
    alignas(32) float position[3][kTogether];
    alignas(32) float weight[kTogether];
    int count;
};

// Takes samples from the front, but for those that weigh nothing. What is left of the block weighs
// nothing.
[[gnu::always_inline]] inline void takeSamples(std::span<const SurfaceSample>& samples,
                                               float offset, SampleBlock& block) {
    std::size_t taken = 0;
    block.count = 0;
    for (; taken < samples.size() && block.count < kTogether; ++taken) {
        const SurfaceSample& sample = samples[taken];
        const float weight = -sample.areaVector.x();
        if (weight == 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
            block.position[axis][block.count] = sample.position[axis] + offset;
        }
        block.weight[block.count++] = weight;
    }
    samples = samples.subspan(taken);
    for (int i = block.count; i < kTogether; ++i) {
        for (auto& positions : block.position) positions[i] = 0;
        block.weight[i] = 0;
    }
}

// As axisWeights, the first nodes and the arguments of the polynomials for a block.
[[gnu::always_inline]] inline void beginWeights(const float* positions, float halfWidth, int* first,
                                                Floats& z) {
    Floats left;
    loadLanes<kTogether>(positions, left);
    left -= halfWidth;
    const Ints truncated = __builtin_convertvector(left, Ints);
    const Ints nodes = truncated - (__builtin_convertvector(truncated, Floats) < left);
    std::memcpy(first, &nodes, sizeof nodes);
    z = 2 * (__builtin_convertvector(nodes, Floats) - left) - 1;
}

// The weights along x and y of all samples at once, and those along z of one after the other, which
// are next to each other in the lattice.
template <int kLanes, int kWidth>
[[gnu::always_inline]] inline void spread(std::span<const SurfaceSample> samples, float offset,
                                          const KernelPolynomials& kernel,
                                          const SpreadLattice& lattice) {
    using Row = typename FloatRow<kLanes>::Type;
    constexpr float kHalfWidth = 0.5F * kWidth;
    SampleBlock block;
    alignas(32) int first[3][kTogether];
    alignas(32) float zArguments[kTogether], lines[kWidth * kWidth][kTogether];
    const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(lattice.yCount) * lattice.zStride;
    while (!samples.empty()) {
        takeSamples(samples, offset, block);
        Floats x, y, z, weight;
        beginWeights(block.position[0], kHalfWidth, first[0], x);
        beginWeights(block.position[1], kHalfWidth, first[1], y);
        beginWeights(block.position[2], kHalfWidth, first[2], z);
        storeLanes<kTogether>(z, zArguments);
        loadLanes<kTogether>(block.weight, weight);

        // Horner's rule.
        Floats wx[kWidth], wy[kWidth];
        for (int j = 0; j < kWidth; ++j) {
            wx[j] = wy[j] = Floats{} + kernel.coefficients[j];
            for (int p = 1; p <= kernel.degree; ++p) {
                const float next = kernel.coefficients[p * SpreadingKernel::kPaddedWidth + j];
                wx[j] = wx[j] * x + next;
                wy[j] = wy[j] * y + next;
            }
            wx[j] *= weight;
        }
        for (int i = 0; i < kWidth; ++i) {
            for (int j = 0; j < kWidth; ++j) {
                storeLanes<kTogether>(wx[i] * wy[j], lines[i * kWidth + j]);
            }
        }

        for (int n = 0; n < block.count; ++n) {
            Row wz = *reinterpret_cast<const Row*>(kernel.coefficients);
            for (int p = 1; p <= kernel.degree; ++p) {
                wz = wz * zArguments[n] +
                     *reinterpret_cast<const Row*>(kernel.coefficients +
                                                   p * SpreadingKernel::kPaddedWidth);
            }
            float* rows = lattice.nodes + first[0][n] * plane +
                          static_cast<std::ptrdiff_t>(first[1][n]) * lattice.zStride + first[2][n];
            for (int i = 0; i < kWidth; ++i, rows += plane) {
                float* row = rows;
                for (int j = 0; j < kWidth; ++j, row += lattice.zStride) {
                    *reinterpret_cast<Row*>(row) += lines[i * kWidth + j][n] * wz;
                }
            }
        }
    }
}

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

// Loops of a known length stay in registers: a function for each width there is, from 2.
template <int... kWidths>
[[gnu::always_inline]] inline void spreadByWidth(std::integer_sequence<int, kWidths...> /*all*/,
                                                 std::span<const SurfaceSample> samples,
                                                 float offset, const KernelPolynomials& kernel,
                                                 const SpreadLattice& lattice) {
    const auto tryWidth = [&]<int kWidth>() __attribute__((always_inline)) {
        if constexpr (kWidth >= 2) {
            if (kernel.width == kWidth) {
                spread<kWidth <= 8 ? 8 : 16, kWidth>(samples, offset, kernel, lattice);
            }
        }
    };
    (tryWidth.template operator()<kWidths>(), ...);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void spreadAll(std::span<const SurfaceSample> samples, float offset,
               const KernelPolynomials& kernel, const SpreadLattice& lattice) {
    spreadByWidth(std::make_integer_sequence<int, SpreadingKernel::kMaximumWidth + 1>(), samples,
                  offset, kernel, lattice);
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
    spreadAll(samples, offset, polynomialsOf(kernel), lattice);
}

void spreadSamples(std::span<const PairedSample> samples, float offset,
                   const SpreadingKernel& kernel, const SpreadLattice& lattice) {
    const auto spreadPaired = kernel.paddedWidth() == 8 ? spreadNarrowPairs : spreadWidePairs;
    spreadPaired(samples, offset, polynomialsOf(kernel), lattice);
}

}  // namespace bandvox
