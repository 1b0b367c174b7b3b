// What the way from a surface to a grid is made of.

#include "bandlimit/fill_columns.h"
#include "bandlimit/grid_assembly.h"
#include "bandlimit/spread_samples.h"
#include "bandlimit/tile_filter.h"
#include "bandlimit/tile_plan.h"
#include "core/instruction_sets.h"

#include <bandvox/source/shapes.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace bandvox {
namespace {

constexpr int kSide = 64;
constexpr int kSamples = 8192;

// Samples of a plane through a tile, in no order; all of their nodes are in it.
std::vector<SurfaceSample> samplesOfPlane() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> across(12, kSide - 12);
    std::vector<SurfaceSample> samples;
    for (int i = 0; i < kSamples; ++i) {
        const float y = across(random), z = across(random);
        samples.push_back({{0.3F * y + 0.2F * z + 12, y, z}, {0.05F, 0.02F, 0.01F}});
    }
    return samples;
}

// A pair of a multiplication and an addition counts as two.
void countOperations(benchmark::State& state, double operations) {
    state.counters["flop/s"] =
        benchmark::Counter(operations, benchmark::Counter::kIsIterationInvariantRate);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void multiplyAndAdd(float* values, std::size_t count, float factor) {
    for (std::size_t i = 0; i < count; ++i) values[i] = values[i] * factor + 1e-6F;
}

// The limit of the next: so many floats as the nodes around a sample are, of those in the first
// cache, read, multiplied, added to and written.
void multiplyAddInFirstCache(benchmark::State& state) {
    std::vector<float> values(2048, 1);
    float factor = 1;
    for (auto _ : state) {
        multiplyAndAdd(values.data(), values.size(), factor);
        factor = 2 - factor;
        benchmark::DoNotOptimize(values.data());
        benchmark::ClobberMemory();
    }
    countOperations(state, 2.0 * static_cast<double>(values.size()));
}
BENCHMARK(multiplyAddInFirstCache);

// What is counted are the nodes of the kernel's support, none of the padding, and no weights.
void spread(benchmark::State& state) {
    DensityOptions options;
    options.tolerance = std::pow(10.0, -state.range(0));
    const TilePlan plan = makeTilePlan(options);
    const std::vector<SurfaceSample> samples = samplesOfPlane();
    constexpr int kZ = kSide + SpreadingKernel::kPaddedWidth;
    std::vector<float> nodes(std::size_t(kSide) * kSide * kZ);
    for (auto _ : state) {
        spreadSamples(samples, 0, plan.kernel, {nodes.data(), kSide, kZ});
        benchmark::ClobberMemory();
    }
    countOperations(state, 2.0 * kSamples * std::pow(plan.kernel.width(), 3));
    state.counters["width"] = plan.kernel.width();
    state.SetItemsProcessed(state.iterations() * kSamples);
}
BENCHMARK(spread)->DenseRange(3, 6)->ArgName("digits");

void filterTile(benchmark::State& state) {
    const TilePlan plan = makeTilePlan({});
    const TileFilter filter(plan);
    const FftBuffer buffer = filter.allocate();
    const std::vector<SurfaceSample> samples = samplesOfPlane();
    for (auto _ : state) {
        std::fill_n(buffer.get(), filter.bufferSize(), 0.0F);
        filter.spread(samples, buffer.get());
        filter.apply(buffer.get());
        benchmark::ClobberMemory();
    }
    // There and back, each 2.5 n log2 n; the samples take a hundredth of it.
    const double points = std::pow(plan.side, 3);
    countOperations(state, 2 * 2.5 * points * std::log2(points));
}
BENCHMARK(filterTile)->Unit(benchmark::kMicrosecond);

struct Torus {
    explicit Torus(int resolution)
        : source(makeShapeBoundary("shape:torus")),
          plan(makeTilePlan({})),
          layout(layOutTiles(source->bounds(), 2.0 / resolution, plan)),
          filter(plan) {}

    FilledColumns columns() const {
        return fillColumns(*source, plan, layout, filter, "band-limiting", silentProgress());
    }

    std::unique_ptr<BoundarySource> source;
    TilePlan plan;
    TileLayout layout;
    TileFilter filter;
};

// Spreading, transforms, running sum and leaves.
void fillColumnsOfTorus(benchmark::State& state) {
    const Torus torus(static_cast<int>(state.range(0)));
    std::int64_t tiles = 0;
    for (auto _ : state) tiles = torus.columns().total().tiles;
    state.SetItemsProcessed(state.iterations() * tiles);
}
BENCHMARK(fillColumnsOfTorus)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();

void assembleTorus(benchmark::State& state) {
    const Torus torus(static_cast<int>(state.range(0)));
    std::int64_t leaves = 0;
    for (auto _ : state) {
        state.PauseTiming();
        FilledColumns columns = torus.columns();
        state.ResumeTiming();
        leaves = assembleGrid(columns.blocks, torus.layout, {torus.plan.threshold, false})
                     ->tree()
                     .leafCount();
    }
    state.SetItemsProcessed(state.iterations() * leaves);
}
BENCHMARK(assembleTorus)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace bandvox
