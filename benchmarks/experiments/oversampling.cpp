// Is R ≥ 4N enough? The sampled route against the exact one.

#include "experiments.h"
#include "measure.h"
#include "solids.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/source/shapes.h>

#include <functional>
#include <numbers>
#include <string>

namespace bandvox::experiments {

namespace {

using openvdb::Vec3d;

constexpr double kCubeHalf = 24;        // voxels
constexpr int kShapeVoxels = 64;        // along the longest side of a built-in shape
const Vec3d kPlace(0.31, -0.17, 0.43);  // of a solid whose faces lie between samples, voxels

struct Solid {
    std::string name;
    std::unique_ptr<BoundarySource> boundary;
    std::unique_ptr<FieldSource> field;
    double voxelSize = 1;
    bool hasFacesOnSamples = false;
};

Solid shape(const std::string& name, int resolution, bool hasFacesOnSamples) {
    const std::string input = "shape:" + name;
    return {name, makeShapeBoundary(input), makeShapeField(input), 2.0 / resolution,
            hasFacesOnSamples};
}

Solid cube(const std::string& name, double degrees, const Vec3d& center, bool hasFacesOnSamples) {
    Box box{Vec3d(kCubeHalf), center};
    // An axis along none of the lattice's planes.
    box.rotation.setToRotation(Vec3d(0.36, 0.48, 0.80), degrees * std::numbers::pi / 180);
    return {name, std::make_unique<MeshSource>(box.boundary()), std::make_unique<BoxField>(box), 1,
            hasFacesOnSamples};
}

// Its radius is about 32 voxels; its poles, unlike those of the built-in shape, lie between
// samples.
Solid movedSphere(const BoundarySource& boundary, const FieldSource& field) {
    const double voxelSize = 1 / 31.73;
    const Vec3d shift = voxelSize * kPlace;
    return {"sphere between samples", std::make_unique<ShiftedCopies>(boundary, std::vector{shift}),
            std::make_unique<ShiftedField>(field, shift), voxelSize, false};
}

// Refers to a sphere that outlives them.
std::vector<Solid> makeSolids(const Solid& sphere) {
    std::vector<Solid> solids;
    solids.push_back(shape("sphere", kShapeVoxels, false));
    solids.back().name = "sphere on samples";
    solids.push_back(movedSphere(*sphere.boundary, *sphere.field));
    solids.push_back(shape("hyperboloid", kShapeVoxels, true));
    solids.push_back(cube("cube on samples", 0, Vec3d(0.0), true));
    solids.push_back(cube("cube between samples", 0, kPlace, false));
    solids.push_back(cube("cube 10 deg", 10, kPlace, false));
    solids.push_back(cube("cube 30 deg", 30, kPlace, false));
    return solids;
}

DensityResult sampledDensity(const FieldSource& field, const ExponentialFilter& filter,
                             double voxelSize, int oversample) {
    FieldDensityOptions options;
    options.density.voxelSize = voxelSize;
    options.density.filter = filter;
    options.density.tolerance = kTolerance;
    options.oversample = oversample;
    return fieldToDensity(field, options);
}

// More would take long, sharp filters with their wide halos longest.
int mostSamples(const Solid& solid, const ExponentialFilter& filter) {
    if (filter.order > 4) return 8;
    return filter.order > 2 || solid.hasFacesOnSamples ? 16 : 32;
}

void measureSolids(Table& table) {
    const Solid sphere = shape("sphere", kShapeVoxels, false);
    for (const Solid& solid : makeSolids(sphere)) {
        const HalfOnFaces halved(*solid.field);
        for (const ExponentialFilter& filter : kFilters) {
            const DensityResult truth = exactDensity(*solid.boundary, filter, solid.voxelSize);
            const auto measure = [&](const FieldSource& field, const char* faces, int oversample) {
                const DensityResult result =
                    sampledDensity(field, filter, solid.voxelSize, oversample);
                const DensityError error = compare(*result.grid, *truth.grid);
                table.add(solid.name, filter.order, filter.cutoff, faces, oversample, error.largest,
                          error.rms, result.metadata.samplingError, result.fieldSamples,
                          result.spreadSeconds + result.transformSeconds);
            };
            const int most = mostSamples(solid, filter);
            for (int oversample = 1; oversample <= most; oversample *= 2) {
                measure(*solid.field, "inside", oversample);
                if (solid.hasFacesOnSamples && oversample <= 16)
                    measure(halved, "half", oversample);
            }
        }
    }
}

// How a sphere's error grows with its radius, at 4 and at 8 samples per voxel.
void measureRadii(Table& table) {
    const ExponentialFilter& filter = kFilters[0];
    for (const int resolution : {8, 16, 32, 64, 128, 256}) {
        const Solid sphere = shape("sphere", resolution, false);
        const DensityResult truth = exactDensity(*sphere.boundary, filter, sphere.voxelSize);
        for (const int oversample : {4, 8}) {
            if (resolution * oversample > 1024) continue;  // would take long
            const DensityResult result =
                sampledDensity(*sphere.field, filter, sphere.voxelSize, oversample);
            const DensityError error = compare(*result.grid, *truth.grid);
            table.add(resolution / 2, filter.order, filter.cutoff, oversample, error.largest,
                      error.rms);
        }
    }
}

}  // namespace

void measureOversampling(const Folder& folder) {
    Table solids =
        folder.table("oversampling",
                     "solid,order,cutoff,faces,samples_per_voxel,largest_error,rms_error,"
                     "stated_error,samples,cpu_seconds");
    measureSolids(solids);
    Table radii = folder.table("sphere_radius",
                               "radius,order,cutoff,samples_per_voxel,largest_error,rms_error");
    measureRadii(radii);
}

}  // namespace bandvox::experiments
