// Times the pruned algorithms of N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling"
// (1990) against FFTW's dense three-dimensional transforms of the same size:
//
//   Algorithm I   R³ samples of a shape become N³ frequencies
//   Algorithm II  N³ frequencies become an M×M screen of depths and normals; the dense inverse
//                 finds depths only, so it is given less to do
//
// Each variant runs in a process of its own, by turns; printed are medians. What they find is
// compared first. Not timed are the starting of threads and the dense transform's plan; the
// library's plans, of N points, are.

#include "dense_transform.h"
#include "process_measurement.h"

#include <bandvox/core/parallel.h>
#include <bandvox/source/shapes.h>
#include <bandvox/spectral/field_to_spectrum.h>
#include <bandvox/spectral/spectrum_to_screen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace bandvox;
using benchmarks::DenseTransform;
using benchmarks::measure;
using benchmarks::Measurement;
using benchmarks::Variant;
using Callback = std::function<void()>;

constexpr double kDomainSide = 3;  // the sphere's diameter is 2

struct Settings {
    int rounds = 5;
    std::string shape = "shape:sphere";
};

SpectrumOptions spectrumOptions(int samples, int resolution) {
    SpectrumOptions options;
    options.samples = samples;
    options.resolution = resolution;
    options.domain = SpectralDomain{openvdb::Vec3d(-0.5 * kDomainSide), kDomainSide};
    return options;
}

// Lets TBB start its threads, and FFTW make the library's plans.
void warmUp(const FieldSource& field) {
    SpectrumOptions options = spectrumOptions(32, 8);
    const SpectralVolume volume = fieldToSpectrum(field, options);
    spectrumToScreen(volume, {.magnification = 2});
}

Variant algorithmI(const Settings& settings, int samples, int resolution) {
    return {"Algorithm I", [=](const Callback& begin, const Callback& end) {
                const auto field = makeShapeField(settings.shape);
                warmUp(*field);
                begin();
                fieldToSpectrum(*field, spectrumOptions(samples, resolution));
                end();
            }};
}

Variant denseForward(const Settings& settings, int samples, int resolution) {
    return {"dense FFTW", [=](const Callback& begin, const Callback& end) {
                const auto field = makeShapeField(settings.shape);
                warmUp(*field);
                const SpectrumOptions options = spectrumOptions(samples, resolution);
                DenseTransform dense(samples, threadCount(), false);
                begin();
                dense.lowPass(*field, resolution, options.filter, *options.domain);
                end();
            }};
}

Variant algorithmII(const Settings& settings, int resolution, int magnification, bool onlySeen) {
    return {onlySeen ? "section 5.3" : "Algorithm II",
            [=](const Callback& begin, const Callback& end) {
                const auto field = makeShapeField(settings.shape);
                const SpectralVolume volume =
                    fieldToSpectrum(*field, spectrumOptions(8 * resolution, resolution));
                warmUp(*field);
                begin();
                spectrumToScreen(volume, {.magnification = magnification, .onlySeen = onlySeen});
                end();
            }};
}

Variant denseInverse(const Settings& settings, int resolution, int magnification) {
    return {"dense FFTW", [=](const Callback& begin, const Callback& end) {
                const auto field = makeShapeField(settings.shape);
                const SpectralVolume volume =
                    fieldToSpectrum(*field, spectrumOptions(8 * resolution, resolution));
                DenseTransform dense(resolution * magnification, threadCount(), true);
                begin();
                dense.crossings(volume, 0.5F);
                end();
            }};
}

double seenPart(const Settings& settings, int resolution, int magnification) {
    const auto field = makeShapeField(settings.shape);
    const Screen screen =
        spectrumToScreen(fieldToSpectrum(*field, spectrumOptions(8 * resolution, resolution)),
                         {.magnification = magnification});
    double seen = 0;
    for (const float depth : screen.depth) seen += std::isinf(depth) ? 0 : 1;
    return seen / static_cast<double>(screen.depth.size());
}

void report(const std::string& title, const std::vector<Variant>& variants,
            const std::vector<Measurement>& medians) {
    std::printf("%s\n", title.c_str());
    std::printf("  %-14s %9s %9s %12s %12s\n", "", "s", "MB", "dense s / s", "dense MB / MB");
    for (std::size_t v = 0; v < variants.size(); ++v) {
        std::printf("  %-14s %9.4f %9.2f %12.1f %12.1f\n", variants[v].name.c_str(),
                    medians[v].seconds, medians[v].megabytes,
                    medians[0].seconds / medians[v].seconds,
                    medians[0].megabytes / medians[v].megabytes);
    }
    std::fflush(stdout);
}

// Both ways have to come to the same, or their times say nothing.
void checkForward(const Settings& settings, int samples, int resolution) {
    const auto field = makeShapeField(settings.shape);
    const SpectrumOptions options = spectrumOptions(samples, resolution);
    const SpectralVolume pruned = fieldToSpectrum(*field, options);
    const SpectralVolume dense = DenseTransform(samples, threadCount(), false)
                                     .lowPass(*field, resolution, options.filter, *options.domain);
    float largest = 0, difference = 0;
    for (int l = 0; l < resolution; ++l) {
        for (int m = 0; m < resolution; ++m) {
            for (int n = 0; 2 * n < resolution; ++n) {
                largest = std::max(largest, std::abs(dense.row(l, m)[n]));
                difference =
                    std::max(difference, std::abs(dense.row(l, m)[n] - pruned.row(l, m)[n]));
            }
        }
    }
    if (!(difference <= 1e-5F * largest)) throw std::runtime_error("the frequencies differ");
}

void checkInverse(const Settings& settings, int resolution, int magnification) {
    constexpr float kIso = 0.5F;
    const auto field = makeShapeField(settings.shape);
    const SpectralVolume volume =
        fieldToSpectrum(*field, spectrumOptions(8 * resolution, resolution));
    const Screen screen = spectrumToScreen(volume, {.magnification = magnification, .iso = kIso});
    const int m = screen.size;
    const std::vector<int> dense = DenseTransform(m, threadCount(), true).crossings(volume, kIso);
    std::size_t different = 0;
    for (int x = 0; x < m; ++x) {
        for (int y = 0; y < m; ++y) {
            const float depth = screen.depth[static_cast<std::size_t>(y) * m + x];
            const int z = dense[static_cast<std::size_t>(x) * m + y];
            // The screen has the step before the crossing where that is nearer.
            const bool isSame = z < 0 ? std::isinf(depth)
                                      : std::abs(depth * static_cast<float>(magnification) -
                                                 static_cast<float>(z)) < 1.01F;
            if (!isSame) ++different;
        }
    }
    // Rounding decides at the rim.
    if (different > dense.size() / 10000) throw std::runtime_error("the crossings differ");
}

// Runs a check where threads may be started: not here, where processes are made.
void checkInChild(const std::function<void()>& check) {
    measure({{"comparison",
              [&](const Callback& begin, const Callback& end) {
                  begin();
                  check();
                  end();
              }}},
            1);
}

void compareForward(const Settings& settings, int samples, int resolution) {
    checkInChild([&] { checkForward(settings, samples, resolution); });
    const std::vector<Variant> variants{denseForward(settings, samples, resolution),
                                        algorithmI(settings, samples, resolution)};
    report("R = " + std::to_string(samples) + ", N = " + std::to_string(resolution), variants,
           measure(variants, settings.rounds));
}

void compareInverse(const Settings& settings, int resolution, int magnification) {
    checkInChild([&] { checkInverse(settings, resolution, magnification); });
    const std::vector<Variant> variants{denseInverse(settings, resolution, magnification),
                                        algorithmII(settings, resolution, magnification, false),
                                        algorithmII(settings, resolution, magnification, true)};
    report("N = " + std::to_string(resolution) + ", L = " + std::to_string(magnification) +
               ", M = " + std::to_string(resolution * magnification),
           variants, measure(variants, settings.rounds));
}

void runLarge(const Settings& settings) {
    const std::vector<Variant> variants{algorithmI(settings, 1024, 256)};
    const Measurement one = measure(variants, 1).front();
    std::printf("R = 1024, N = 256 (the dense array would be 4303 MB)\n  %-14s %9.4f s %9.2f MB\n",
                variants[0].name.c_str(), one.seconds, one.megabytes);
}

}  // namespace

int main(int argc, char** argv) {
    Settings settings;
    if (argc > 1) settings.rounds = std::atoi(argv[1]);
    if (argc > 2) settings.shape = argv[2];
    if (argc > 3 || settings.rounds < 1) {
        std::fprintf(stderr, "usage: spectral_against_fftw [ROUNDS [SHAPE]]\n");
        return 2;
    }
    try {
        std::printf("%s, medians of %d runs\n", settings.shape.c_str(), settings.rounds);
        compareForward(settings, 128, 16);
        compareForward(settings, 256, 32);
        compareInverse(settings, 32, 8);
        compareInverse(settings, 32, 16);
        runLarge(settings);
        std::printf("part of the screen that the shape covers: %.2f\n", seenPart(settings, 32, 8));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "spectral_against_fftw: %s\n", error.what());
        return 1;
    }
    return 0;
}
