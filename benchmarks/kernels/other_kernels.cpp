// The transforms of a part, the fit of scattered values, and the lines of free-form surfaces.

#include "build_places.h"

#include <bandvox/outline/patches_to_outline.h>
#include <bandvox/scatter/fit_surface.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/spectral/pruned_transform.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <vector>

namespace bandvox {
namespace {

using Complex = std::complex<float>;

constexpr int kBatch = 16;

// Algorithm (a): of R samples the N lowest frequencies.
void lowFrequencies(benchmark::State& state) {
    const auto samples = static_cast<int>(state.range(0));
    const auto frequencies = static_cast<int>(state.range(1));
    const LowFrequencyTransform<float> transform(samples, frequencies);
    const std::vector<Complex> in(std::size_t(samples) * kBatch, 1);
    std::vector<Complex> out(std::size_t(frequencies) * kBatch), scratch;
    for (auto _ : state) {
        transform({in.data(), kBatch}, {out.data(), kBatch}, kBatch, scratch);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * samples * kBatch);
}
BENCHMARK(lowFrequencies)->Args({512, 64})->Args({1024, 256})->ArgNames({"R", "N"});

// Algorithm (b): of N frequencies the values at N of LN places.
void phase(benchmark::State& state) {
    const auto frequencies = static_cast<int>(state.range(0));
    const PhaseTransform<float> transform(frequencies, 8);
    const std::vector<Complex> in(std::size_t(frequencies) * kBatch, 1);
    std::vector<Complex> out(in.size()), scratch;
    for (auto _ : state) {
        transform(3, {in.data(), kBatch}, {out.data(), kBatch}, kBatch, scratch);
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * frequencies * kBatch);
}
BENCHMARK(phase)->Arg(64)->Arg(256)->ArgName("N");

void fitScatteredValues(benchmark::State& state) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> across(0, 1);
    ScatteredPoints points;
    points.columns = 1;
    for (int i = 0; i < state.range(0); ++i) {
        points.x.push_back(across(random));
        points.y.push_back(across(random));
        points.values.push_back(std::sin(7 * points.x.back()) * std::cos(5 * points.y.back()));
    }
    FitSurfaceOptions options;
    options.tolerance = 1e-3;
    for (auto _ : state) benchmark::DoNotOptimize(fitSurface(points, options));
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(fitScatteredValues)->Arg(100)->Arg(10000)->Unit(benchmark::kMillisecond)->UseRealTime();

// All lines of Newell's teapot, with what hides them.
void drawTeapot(benchmark::State& state) {
    const PatchModel teapot = readPatches(std::filesystem::path(build_places::sources()) /
                                          "examples" / "data" / "teapot.bpt");
    OutlineOptions options;
    options.camera.projection = CameraOptions::Projection::Orthographic;
    options.camera.from = {1, -2, 0.7};
    options.camera.up = openvdb::Vec3d(0, 0, 1);
    for (auto _ : state) benchmark::DoNotOptimize(patchesToOutline(teapot, options));
}
BENCHMARK(drawTeapot)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace bandvox
