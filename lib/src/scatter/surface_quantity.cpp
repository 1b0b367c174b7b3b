#include <bandvox/scatter/surface_quantity.h>

#include <cstddef>
#include <utility>

namespace bandvox {
namespace {

/// A word, and the orders of the derivative where the quantity is one.
struct QuantityEntry {
    SurfaceQuantity quantity;
    const char* name;
    int dx, dy;
};

constexpr std::array kQuantities{
    QuantityEntry{SurfaceQuantity::Value, "value", 0, 0},
    QuantityEntry{SurfaceQuantity::Dx, "dx", 1, 0},
    QuantityEntry{SurfaceQuantity::Dy, "dy", 0, 1},
    QuantityEntry{SurfaceQuantity::Dxx, "dxx", 2, 0},
    QuantityEntry{SurfaceQuantity::Dxy, "dxy", 1, 1},
    QuantityEntry{SurfaceQuantity::Dyy, "dyy", 0, 2},
    QuantityEntry{SurfaceQuantity::Normal, "normal", 0, 0},
    QuantityEntry{SurfaceQuantity::GaussianCurvature, "gaussian", 0, 0},
    QuantityEntry{SurfaceQuantity::MeanCurvature, "mean", 0, 0},
};

const QuantityEntry& entryOf(SurfaceQuantity quantity) {
    return kQuantities[static_cast<std::size_t>(quantity)];
}

/// First and second derivatives on a grid.
struct SampledJets {
    std::vector<double> dx, dy, dxx, dxy, dyy;

    SurfaceJet at(std::size_t i) const {
        return {0,
                dx[i],
                dy[i],
                dxx.empty() ? 0 : dxx[i],
                dxx.empty() ? 0 : dxy[i],
                dxx.empty() ? 0 : dyy[i]};
    }
};

}  // namespace

const std::vector<SurfaceQuantity>& surfaceQuantities() {
    static const std::vector<SurfaceQuantity> all = [] {
        std::vector<SurfaceQuantity> made;
        made.reserve(kQuantities.size());
        for (const QuantityEntry& entry : kQuantities) made.push_back(entry.quantity);
        return made;
    }();
    return all;
}

std::string nameOf(SurfaceQuantity quantity) {
    return entryOf(quantity).name;
}

std::optional<SurfaceQuantity> surfaceQuantityNamed(std::string_view name) {
    for (const QuantityEntry& entry : kQuantities) {
        if (name == entry.name) return entry.quantity;
    }
    return std::nullopt;
}

int numbersOf(SurfaceQuantity quantity) {
    return quantity == SurfaceQuantity::Normal ? 3 : 1;
}

std::vector<std::vector<double>> sampleQuantity(const BsplineSurface& surface,
                                                std::array<int, 2> samples, int column,
                                                SurfaceQuantity quantity,
                                                const Progress& progress) {
    const auto derivative = [&](int dx, int dy) {
        return surface.sample({samples[0], samples[1], column, dx, dy}, progress);
    };
    const bool isNormal = quantity == SurfaceQuantity::Normal;
    const bool isCurvature = quantity == SurfaceQuantity::GaussianCurvature ||
                             quantity == SurfaceQuantity::MeanCurvature;
    std::vector<std::vector<double>> result;
    if (!isNormal && !isCurvature) {
        result.push_back(derivative(entryOf(quantity).dx, entryOf(quantity).dy));
        return result;
    }
    SampledJets jets{derivative(1, 0), derivative(0, 1), {}, {}, {}};
    if (isCurvature) {
        jets.dxx = derivative(2, 0);
        jets.dxy = derivative(1, 1);
        jets.dyy = derivative(0, 2);
    }
    const std::size_t count = jets.dx.size();
    result.assign(static_cast<std::size_t>(numbersOf(quantity)), std::vector<double>(count));
    constexpr std::size_t kBetweenLooks = std::size_t(1) << 20U;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % kBetweenLooks == 0) progress.throwIfInterrupted();
        const SurfaceJet jet = jets.at(i);
        if (isNormal) {
            const auto normal = jet.normal();
            for (std::size_t k = 0; k < 3; ++k) result[k][i] = normal[k];
        } else {
            result[0][i] = quantity == SurfaceQuantity::GaussianCurvature ? jet.gaussianCurvature()
                                                                          : jet.meanCurvature();
        }
    }
    return result;
}

}  // namespace bandvox
