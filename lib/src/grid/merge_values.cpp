#include "grid/merge_values.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

MergeRule::MergeRule(const MergeOptions& options, std::size_t grids)
    : mOperation(options.operation), mClamp(options.clamp), mWeights(options.weights) {
    if (mWeights.empty()) mWeights.assign(grids, 1);
    if (mOperation == MergeOperation::Blend) {
        double sum = 0;
        for (const double weight : mWeights) sum += weight;
        for (double& weight : mWeights) weight /= sum;
    }
    if (mOperation == MergeOperation::Difference || mOperation == MergeOperation::Intersection) {
        mThreshold = options.threshold;
    }
}

std::optional<float> MergeRule::decidedBy(std::size_t grid, float value) const {
    switch (mOperation) {
        case MergeOperation::Union:
            if (value == 1) return 1.0F;
            break;
        case MergeOperation::Intersection:
            if (value == 0) return 0.0F;
            break;
        case MergeOperation::Difference:
            if (value == (grid == 0 ? 0 : 1)) return 0.0F;
            break;
        default:
            break;
    }
    return std::nullopt;
}

void MergeRule::take(std::size_t grid, const float* values, std::size_t count, double* sums) const {
    if (grid == 0) {
        const bool isWeighted =
            mOperation == MergeOperation::Sum || mOperation == MergeOperation::Blend;
        const double weight = isWeighted ? mWeights[0] : 1;
        for (std::size_t i = 0; i < count; ++i) sums[i] = weight * values[i];
        return;
    }
    switch (mOperation) {
        case MergeOperation::Union:
            for (std::size_t i = 0; i < count; ++i) sums[i] += values[i] * (1 - sums[i]);
            break;
        case MergeOperation::Sum:
        case MergeOperation::Blend:
            for (std::size_t i = 0; i < count; ++i) sums[i] += mWeights[grid] * values[i];
            break;
        case MergeOperation::Max:
            for (std::size_t i = 0; i < count; ++i) sums[i] = std::max<double>(sums[i], values[i]);
            break;
        case MergeOperation::Difference:
            for (std::size_t i = 0; i < count; ++i) sums[i] *= 1.0 - values[i];
            break;
        case MergeOperation::Intersection:
            for (std::size_t i = 0; i < count; ++i) sums[i] *= values[i];
            break;
    }
}

float MergeRule::finished(double sum) const {
    if (std::abs(sum) <= mThreshold) return 0;
    return static_cast<float>(mClamp ? std::clamp(sum, 0.0, 1.0) : sum);
}

}  // namespace bandvox
