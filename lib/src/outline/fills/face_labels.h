#pragma once

#include "outline/drawing/curve_scene.h"
#include "outline/fills/planar_map.h"

#include <bandvox/core/progress.h>

#include <span>
#include <vector>

namespace bandvox {

/// What a face of the page shows.
struct FaceLabel {
    int object = -1;  ///< none: nothing is there
    int tone = 0;     ///< how many of the tones' cosines are below that of the surface

    friend bool operator==(const FaceLabel& a, const FaceLabel& b) {
        return a.object == b.object && a.tone == b.tone;
    }
    friend bool operator<(const FaceLabel& a, const FaceLabel& b) {
        return a.object != b.object ? a.object < b.object : a.tone < b.tone;
    }
};

/// Looks at each face of a map in a few places of it; what most of its area shows counts.
std::vector<FaceLabel> faceLabels(const PlanarMap& map, const CurveScene& scene,
                                  std::span<const double> tones, Progress& progress);

}  // namespace bandvox
