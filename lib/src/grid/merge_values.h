#pragma once

#include <bandvox/grid/merge_grids.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace bandvox {

/// What a merge makes of values, grid by grid.
class MergeRule {
  public:
    /// `options` as mergeGrids takes them, valid for so many grids.
    MergeRule(const MergeOptions& options, std::size_t grids);

    /// The part that a grid has of the result: the derivative by its density, at most.
    double weight(std::size_t grid) const { return mWeights[grid]; }

    /// The result, if a density of a grid decides it whatever those of the others are.
    std::optional<float> decidedBy(std::size_t grid, float value) const;

    /// Takes the values of the next grid, from 0 on, into what those before have come to.
    void take(std::size_t grid, const float* values, std::size_t count, double* sums) const;

    /// The result.
    float finished(double sum) const;

  private:
    MergeOperation mOperation;
    bool mClamp;
    double mThreshold = 0;
    std::vector<double> mWeights;
};

}  // namespace bandvox
