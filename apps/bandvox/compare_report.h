#pragma once

#include <bandvox/compare/compare_grids.h>
#include <bandvox/compare/compare_surfaces.h>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace bandvox::app {

/// What is compared, and what is known of it alone.
struct ComparedInput {
    std::string file;
    std::string grid;  ///< its name; empty of a mesh
    std::optional<double> iso;
    std::optional<double> volume;    ///< inside the surface, world units³
    std::optional<double> integral;  ///< of the density, world units³
};

/// All that is known of the difference of two inputs.
struct ComparisonResult {
    ComparedInput a, b;
    std::optional<GridDifference> values;
    std::optional<SurfaceDifference> surfaces;
    std::optional<double> voxel;  ///< shortest side, world units; of the first grid of the two
};

/// Keys: a and b ({file, grid, iso, volume, integral}, null where there is none), voxel; values
/// ({lattices: "same", "shifted" or "resampled", voxels, maximum, at, a, b, rms, mean,
/// mean_absolute}) and surfaces ({hausdorff, hausdorff_at_most, mean_distance, from_a and from_b
/// ({maximum, at_most, at, nearest, mean, rms, area}), angle ({mean, percent_95, maximum})}), null
/// if they were not compared; volume_difference and integral_difference, b less a in parts of a, or
/// null. World units and degrees.
nlohmann::ordered_json comparisonReport(const ComparisonResult& result);

/// The same for people.
std::string comparisonInWords(const ComparisonResult& result);

/// The difference of two numbers in parts of the first; nothing without them, or if the first is 0.
std::optional<double> relativeDifference(const std::optional<double>& a,
                                         const std::optional<double>& b);

}  // namespace bandvox::app
