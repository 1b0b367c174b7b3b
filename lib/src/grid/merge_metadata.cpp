#include "grid/merge_metadata.h"

#include "core/words.h"

#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>

#include <algorithm>
#include <cmath>

namespace bandvox {

namespace {

// "union of a.obj and b.obj".
std::string mergedSource(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                         MergeOperation operation) {
    std::string text = nameOf(operation) + " of ";
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (i > 0) text += i + 1 < grids.size() ? ", " : " and ";
        const std::string source = sourceOf(*grids[i]);
        text += source.empty() ? "unknown" : source;
    }
    return text;
}

// What one of the inputs' errors may have become.
class MergedError {
  public:
    MergedError(MergeOperation operation, const MergeRule& rule)
        : mOperation(operation), mRule(rule) {}

    void add(std::size_t grid, double error) {
        if (std::isnan(error) || std::isnan(mSum)) {
            mSum = std::nan("");
        } else if (mOperation == MergeOperation::Max) {
            mSum = std::max(mSum, error);
        } else {
            mSum += std::abs(mRule.weight(grid)) * error;
        }
    }
    double sum() const { return mSum; }

  private:
    MergeOperation mOperation;
    const MergeRule& mRule;
    double mSum = 0;
};

bool isLinear(MergeOperation operation) {
    return operation == MergeOperation::Sum || operation == MergeOperation::Blend;
}

// 0 if it is not known.
double mergedVolume(const std::vector<DensityMetadata>& inputs, MergeOperation operation,
                    const MergeRule& rule) {
    double sum = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (!isLinear(operation) || inputs[i].sourceVolume == 0) return 0;
        sum += rule.weight(i) * inputs[i].sourceVolume;
    }
    return sum;
}

DensityMetadata mergedMetadata(const std::vector<DensityMetadata>& inputs,
                               const MergeOptions& options, const MergeRule& rule) {
    DensityMetadata merged = inputs.front();
    MergedError tolerance(options.operation, rule), closure(options.operation, rule),
        sampling(options.operation, rule), storage(options.operation, rule);
    merged.holesCapped = 0;
    merged.clamped = options.clamp;
    merged.oversampling = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const DensityMetadata& input = inputs[i];
        tolerance.add(i, input.tolerance);
        closure.add(i, input.closureError);
        sampling.add(i, input.samplingError);
        storage.add(i, input.storageError);
        merged.holesCapped += input.holesCapped;
        merged.clamped = merged.clamped || input.clamped;
    }
    merged.tolerance = tolerance.sum();
    merged.closureError = closure.sum();
    merged.samplingError = sampling.sum();
    merged.storageError = storage.sum();
    merged.sourceVolume = options.clamp ? 0 : mergedVolume(inputs, options.operation, rule);
    merged.version = version();
    merged.route = "merged";
    return merged;
}

std::string filterInWords(const DensityMetadata& metadata) {
    return "order " + inShort(metadata.order) + ", cutoff " + inShort(metadata.cutoff);
}

// Whether each input is a density of this library with the filter of the first. Says so if not.
bool haveOneFilter(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                   std::vector<DensityMetadata>& inputs, std::vector<std::string>& warnings) {
    constexpr double kSameFilter = 1e-6;
    std::size_t unknown = 0;
    for (const auto& grid : grids) {
        const auto metadata = densityMetadata(*grid);
        if (metadata) {
            inputs.push_back(*metadata);
        } else {
            ++unknown;
        }
    }
    if (unknown == grids.size()) return false;
    if (unknown > 0) {
        warnings.push_back(counted(unknown, "of the grids does", "of the grids do") +
                           " not say by which filter it was made, so the result says of none");
        return false;
    }
    for (const DensityMetadata& input : inputs) {
        if (std::abs(input.order - inputs[0].order) <= kSameFilter * input.order &&
            std::abs(input.cutoff - inputs[0].cutoff) <= kSameFilter * input.cutoff) {
            continue;
        }
        warnings.push_back("the grids were made by different filters (" + filterInWords(inputs[0]) +
                           ", and " + filterInWords(input) + "), so the result says of none");
        return false;
    }
    return true;
}

}  // namespace

void describeMerged(const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                    const MergeOptions& options, const MergeRule& rule, MergeResult& result) {
    const std::string source = mergedSource(grids, options.operation);
    // What one of them says holds for all.
    PlaceMetadata place;
    for (const auto& grid : grids) {
        const PlaceMetadata own = placeMetadata(*grid);
        if (place.unit.empty()) place.unit = own.unit;
        if (place.space.empty()) place.space = own.space;
    }
    setPlaceMetadata(*result.grid, place);
    std::vector<DensityMetadata> inputs;
    if (!haveOneFilter(grids, inputs, result.warnings)) {
        setSourceMetadata(*result.grid, source);
        return;
    }
    for (const DensityMetadata& input : inputs) {
        if (input.iso == inputs[0].iso) continue;
        result.warnings.push_back("the iso-values of the grids differ (" + inShort(inputs[0].iso) +
                                  " and " + inShort(input.iso) +
                                  "); the result has that of the first");
        break;
    }
    DensityMetadata merged = mergedMetadata(inputs, options, rule);
    merged.source = source;
    merged.gridVolume = densityIntegral(*result.grid);
    setDensityMetadata(*result.grid, merged);
}

}  // namespace bandvox
