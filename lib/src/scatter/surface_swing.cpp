#include "scatter/surface_swing.h"

#include <algorithm>
#include <cstddef>

namespace bandvox {

double swingOf(const std::vector<BsplineSurface>& levels, const ScatteredPoints& points) {
    constexpr int kSamples = 129;
    double swing = 0;
    for (int column = 0; column < points.columns; ++column) {
        std::vector<double> sum(static_cast<std::size_t>(kSamples) * kSamples);
        for (const BsplineSurface& level : levels) {
            const std::vector<double> part = level.sample({kSamples, kSamples, column});
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
        }
        double low = points.value(0, column);
        double high = low;
        for (std::size_t i = 1; i < points.size(); ++i) {
            low = std::min(low, points.value(i, column));
            high = std::max(high, points.value(i, column));
        }
        const auto [least, most] = std::minmax_element(sum.begin(), sum.end());
        const double range = high > low ? high - low : 1;
        swing = std::max({swing, (low - *least) / range, (*most - high) / range});
    }
    return swing;
}

}  // namespace bandvox
