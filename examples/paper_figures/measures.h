#pragma once

#include "pictures.h"

#include <cstddef>

namespace paper_figures {

/// Within so many pixels, or world units, of an edge or an outline is not counted as off edges.
inline constexpr int kEdgePixels = 4;
inline constexpr double kEdgeDistance = kEdgePixels * kDomainSide / kScreen;

/// Angles between the normals of a picture and the true ones, degrees.
struct NormalErrors {
    std::size_t pixels = 0;  ///< measured
    double mean = 0, percentile95 = 0, largest = 0;
};

/// The true normal is that of the surface's point that is nearest to what the pixel shows. Pixels
/// for which that point is nearer to an edge than `edgeDistance`, world units, are left out.
NormalErrors normalErrors(const bandvox::Image& image, const TrueSurface& surface,
                          double edgeDistance);

/// How rough shades are along rows: the root of the mean square of s(i-1) - 2 s(i) + s(i+1).
struct Roughness {
    std::size_t triples = 0;  ///< of pixels measured
    double picture = 0;
    double truth = 0;  ///< of the true picture at the same pixels
};

/// Left out are triples with a pixel that in either picture is within `margin` pixels of one that
/// sees nothing, or in the true one of an edge: there shades change by right.
Roughness roughness(const bandvox::Image& image, const TruePicture& truth, int margin);

}  // namespace paper_figures
