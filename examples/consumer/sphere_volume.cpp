// Makes the density of a sphere and compares its integral with the sphere's volume.

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/version.h>
#include <bandvox/source/shapes.h>

#include <cmath>
#include <iostream>
#include <numbers>

int main() {
    const auto sphere = bandvox::makeShapeBoundary("shape:sphere");
    bandvox::DensityOptions options;
    options.resolution = 32;
    const bandvox::DensityResult result = bandvox::surfaceToDensity(*sphere, options);

    const double volume = 4.0 / 3.0 * std::numbers::pi;  // of radius 1
    std::cout << "bandvox " << bandvox::version() << ": volume " << result.metadata.gridVolume
              << ", exactly " << volume << '\n';
    return std::abs(result.metadata.gridVolume - volume) <= 1e-3 * volume ? 0 : 1;
}
