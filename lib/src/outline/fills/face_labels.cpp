#include "outline/fills/face_labels.h"

#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace bandvox {
namespace {

// Where rows of a face lie, as shares of its height: not where a symmetric shape has its corners.
constexpr std::array kRows{0.4935, 0.2718, 0.7329, 0.1214, 0.8871};

/// A place within a face, and how wide the face is there.
struct FaceSample {
    double x, y, width;
};

// The middles of the widest parts of some rows of a face. `halves`: all those of its borders.
std::vector<FaceSample> samplesOf(const PlanarMap& map, std::span<const std::int32_t> halves) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::int32_t h : halves) {
        const double y = map.halves[static_cast<std::size_t>(h)].start[1];
        low = std::min(low, y);
        high = std::max(high, y);
    }
    std::vector<FaceSample> samples;
    std::vector<double> passes;
    for (const double share : kRows) {
        const double y = low + share * (high - low);
        passes.clear();
        for (const std::int32_t h : halves) {
            const PlanarMap::HalfEdge& half = map.halves[static_cast<std::size_t>(h)];
            const auto& a = half.start;
            const auto& b = map.halves[static_cast<std::size_t>(half.twin)].start;
            if ((a[1] <= y) == (b[1] <= y)) continue;
            passes.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
        }
        std::sort(passes.begin(), passes.end());
        FaceSample widest{0, y, 0};
        for (std::size_t k = 0; k + 1 < passes.size(); k += 2) {
            const double width = passes[k + 1] - passes[k];
            if (width > widest.width) widest = {0.5 * (passes[k] + passes[k + 1]), y, width};
        }
        if (widest.width > 0) samples.push_back(widest);
    }
    return samples;
}

FaceLabel labelOf(const SeenSurface& seen, std::span<const double> tones) {
    FaceLabel label;
    label.object = seen.object;
    if (seen.object < 0) return label;
    label.tone = static_cast<int>(std::count_if(
        tones.begin(), tones.end(), [&](double cosine) { return seen.cosine > cosine; }));
    return label;
}

}  // namespace

std::vector<FaceLabel> faceLabels(const PlanarMap& map, const CurveScene& scene,
                                  std::span<const double> tones, Progress& progress) {
    std::vector<std::vector<std::int32_t>> halves(static_cast<std::size_t>(map.faces));
    for (std::size_t h = 0; h < map.halves.size(); ++h) {
        halves[static_cast<std::size_t>(map.halves[h].face)].push_back(
            static_cast<std::int32_t>(h));
    }
    std::vector<FaceLabel> labels(halves.size());
    constexpr std::int64_t kAtOnce = 16;  // faces that share a reader
    const auto count = static_cast<std::int64_t>(labels.size());
    parallelFor((count + kAtOnce - 1) / kAtOnce, [&](std::int64_t block) {
        progress.throwIfInterrupted();
        const auto reader = scene.reader();
        const std::int64_t end = std::min(count, (block + 1) * kAtOnce);
        for (std::int64_t f = block * kAtOnce; f < end; ++f) {
            if (f == map.outside) continue;
            std::map<FaceLabel, double> votes;
            for (const FaceSample& s : samplesOf(map, halves[static_cast<std::size_t>(f)])) {
                votes[labelOf(reader->seenAt(s.x, s.y), tones)] += s.width;
            }
            const auto best =
                std::max_element(votes.begin(), votes.end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; });
            if (best != votes.end()) labels[static_cast<std::size_t>(f)] = best->first;
        }
    });
    return labels;
}

}  // namespace bandvox
