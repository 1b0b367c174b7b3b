// Looks at a built-in shape as the paper does, by Algorithms I and II, and says what they multiply.
//
//     shape_to_screen SHAPE
//
// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), section 5;
// docs/math/pruned-transforms.md quotes this program and what it says of shape:torus.

#include <bandvox/core/error.h>
#include <bandvox/source/shapes.h>
#include <bandvox/spectral/field_to_spectrum.h>
#include <bandvox/spectral/spectrum_to_screen.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>

namespace {

// Multiplications of Algorithm I by the paper's formula, (R² + RN + N²) T_N.
double lowPassFormula(double n, double r) {
    return (r * r + r * n + n * n) * r * (1 + std::log2(n));
}

// Of Algorithm II, section 5.2: densities, and the z, x and y components of the gradient.
double lookFormula(double n, double l) {
    const double magnify = l * n * (1 + std::log2(n));  // T_A
    return ((1 + l + l * l) + l + (l + 1)) * n * n * magnify + 3 * l * l * n * n * n;
}

void report(const char* what, const bandvox::OperationCount& count, double formula) {
    std::cout << std::left << std::setw(28) << what << std::scientific << std::setprecision(1)
              << count.multiplications << " multiplications, the paper's formula " << formula
              << '\n';
}

void lookAt(const bandvox::FieldSource& solid) {
    // Algorithm I: 128³ samples, of which 32³ frequencies are kept.
    bandvox::SpectrumOptions options;
    options.resolution = 32;
    options.samples = 128;
    bandvox::OperationCount sampling;
    const bandvox::SpectralVolume volume =
        bandvox::fieldToSpectrum(solid, options, bandvox::silentProgress(), &sampling);

    // Algorithm II: along 256² lines of sight, where is the density first above 0.5?
    bandvox::ScreenOptions look;
    look.magnification = 8;
    look.iso = 0.5;
    bandvox::OperationCount looking;
    const bandvox::Screen screen =
        bandvox::spectrumToScreen(volume, look, bandvox::silentProgress(), &looking);

    const auto isSeen = [](float depth) { return !std::isinf(depth); };
    std::cout << std::count_if(screen.depth.begin(), screen.depth.end(), isSeen) << " of "
              << screen.depth.size() << " lines of sight meet the surface\n";

    look.onlySeen = false;
    bandvox::OperationCount everywhere;
    bandvox::spectrumToScreen(volume, look, bandvox::silentProgress(), &everywhere);

    const double formula = lookFormula(options.resolution, look.magnification);
    report("Algorithm I:", sampling, lowPassFormula(options.resolution, options.samples));
    report("Algorithm II:", everywhere, formula);
    report("Algorithm II, section 5.3:", looking, formula);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: shape_to_screen SHAPE\n";
        return static_cast<int>(bandvox::ErrorKind::Usage);
    }
    try {
        lookAt(*bandvox::makeShapeField(argv[1]));
        return EXIT_SUCCESS;
    } catch (const bandvox::Error& error) {
        std::cerr << error.what() << '\n';
        return error.exitStatus();
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
