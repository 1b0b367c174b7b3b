// What reads a density between its voxels, and draws it.

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/reconstruct/brick_reconstruction.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/source/shapes.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace bandvox {
namespace {

openvdb::FloatGrid::Ptr ball(int resolution) {
    DensityOptions options;
    options.resolution = resolution;
    return surfaceToDensity(*makeShapeBoundary("shape:sphere"), options).grid;
}

// Places near the ball's surface, in index coordinates, one after another along circles.
std::vector<openvdb::Vec3d> placesOnBall(int resolution) {
    constexpr int kPlaces = 4096;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> beside(-1, 1);
    std::vector<openvdb::Vec3d> places;
    for (int i = 0; i < kPlaces; ++i) {
        const double turn = 2 * std::numbers::pi * i / 512, z = 0.9 * (2.0 * i / kPlaces - 1);
        const double radius = 0.5 * resolution + beside(random);
        const double r = std::sqrt(1 - z * z);
        places.push_back(radius * openvdb::Vec3d(r * std::cos(turn), r * std::sin(turn), z));
    }
    return places;
}

template <typename Read>
void readBall(benchmark::State& state, const Read& read) {
    constexpr int kResolution = 128;
    BrickReconstructionOptions options;
    options.filter = DensityOptions().filter;
    const auto field = makeBrickReconstruction(ball(kResolution), options);
    const std::vector<openvdb::Vec3d> places = placesOnBall(kResolution);
    const auto probe = field->probe();
    for (const openvdb::Vec3d& place : places) probe->value(place);  // makes the bricks
    for (auto _ : state) {
        double sum = 0;
        for (const openvdb::Vec3d& place : places) sum += read(*probe, place);
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}

void value(benchmark::State& state) {
    readBall(state, [](DensityProbe& probe, const openvdb::Vec3d& p) { return probe.value(p); });
}
BENCHMARK(value);

void valueAndGradient(benchmark::State& state) {
    readBall(state, [](DensityProbe& probe, const openvdb::Vec3d& p) {
        return probe.evaluate(p).gradient[0];
    });
}
BENCHMARK(valueAndGradient);

void valueGradientAndHessian(benchmark::State& state) {
    readBall(state, [](DensityProbe& probe, const openvdb::Vec3d& p) {
        return probe.expand(p).hessian(0, 1);
    });
}
BENCHMARK(valueGradientAndHessian);

// All coefficients of one brick after another, with a cache that holds none for long.
void makeBricks(benchmark::State& state) {
    constexpr int kResolution = 256;
    BrickReconstructionOptions options;
    options.filter = DensityOptions().filter;
    options.cacheBytes = 0;
    const auto field = makeBrickReconstruction(ball(kResolution), options);
    const auto probe = field->probe();
    constexpr int kBricks = 8, kSide = 32;
    for (auto _ : state) {
        for (int x = 0; x < kBricks; ++x) {
            for (int y = 0; y < kBricks; ++y) {
                for (int z = 0; z < kBricks; ++z) {
                    const openvdb::Vec3d brick(x + 0.5, y + 0.5, z + 0.5);
                    benchmark::DoNotOptimize(
                        probe->value(kSide * brick - openvdb::Vec3d(0.5 * kBricks * kSide)));
                }
            }
        }
    }
    state.SetItemsProcessed(state.iterations() * kBricks * kBricks * kBricks);
}
BENCHMARK(makeBricks)->Unit(benchmark::kMillisecond);

// Everything from the grid to the pixels.
void drawBall(benchmark::State& state) {
    const openvdb::FloatGrid::Ptr grid = ball(static_cast<int>(state.range(0)));
    RenderOptions options;
    options.width = options.height = 512;
    for (auto _ : state) benchmark::DoNotOptimize(densityToImage(grid, options));
    state.SetItemsProcessed(state.iterations() * options.width * options.height);
}
BENCHMARK(drawBall)->Arg(128)->Arg(256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace bandvox
