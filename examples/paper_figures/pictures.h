#pragma once

#include "true_surface.h"

#include <bandvox/render/image.h>
#include <bandvox/render/shading.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/Types.h>

#include <array>
#include <string>
#include <vector>

namespace paper_figures {

/// All solids lie in the middle of a cube of this side, world units. Its points
/// -kDomainSide/2 + (i, j, k)·kDomainSide/n are the samples, the voxels' centres, and what the
/// screen looks at through the middles of its pixels: one set of places for all methods.
inline constexpr double kDomainSide = 2.8;

/// M, the pixels along each side of the figures' screens.
inline constexpr int kScreen = 64;

/// A light far away.
struct Light {
    std::string name;  ///< for files
    std::string caption;
    openvdb::Vec3d direction;  ///< towards it, in the camera's axes: right, up, back to the eye
};

/// Those of figure 8: from the front, on the near side; from the upper right.
enum LightIndex { kFront, kUpperRight };
const std::array<Light, 2>& lights();

// Pictures are of size × size pixels, seen from the domain's face z = -kDomainSide/2 along +z with
// y up, so x to the left. Their colour is the shade, 0 to 1, by Lambert's cosine law alone.

/// What a formula's surface looks like, and how far each pixel's place is from an edge.
struct TruePicture {
    bandvox::Image image;
    std::vector<double> edgeDistance;  ///< [size][size] world units; infinite where nothing
};
TruePicture truePicture(const TrueSurface& surface, int size, const Light& light);

/// How a picture is made by the paper's method.
struct SpectralSetting {
    int samples = 64;      ///< R
    int resolution = 8;    ///< N
    int size = 64;         ///< M, a multiple of N
    double isoPart = 0.5;  ///< iso-value d over the largest density of the voxels
    bool refine = false;   ///< find crossings below the step 1/L; else by the rule of figure 7
    /// The paper gives neither order nor cutoff. This keeps much, leaves 2e-4 at Nyquist, and
    /// overshoots by 7 % at flat faces.
    bandvox::ExponentialFilter filter{6, 0.35};
};
bandvox::Image spectralPicture(const bandvox::FieldSource& solid, const SpectralSetting& setting,
                               const Light& light);

/// A picture of size³ binary voxels, one pixel for each, by one of the older methods.
bandvox::Image voxelPicture(const bandvox::FieldSource& solid, int size, bandvox::Shading shading,
                            const Light& light);

/// Shades a picture anew by its normals.
void relight(bandvox::Image& image, const Light& light);

/// Shades a picture by its depth alone: the nearer, the brighter, over the depth of `bounds`.
void shadeByDepth(bandvox::Image& image, const openvdb::BBoxd& bounds);

}  // namespace paper_figures
