#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/spectral/pruned_transform.h>
#include <bandvox/spectral/spectral_volume.h>

#include <openvdb/Types.h>

#include <optional>
#include <vector>

namespace bandvox {

/// How a SpectralVolume is looked at: along +z, from its face z = 0, one line of sight through
/// each of M² places of that face, M = LN.
struct ScreenOptions {
    int magnification = 8;  ///< L ≥ 1
    double iso = 0.5;       ///< density that is the surface
    bool onlySeen = true;   ///< section 5.3: compute no more than lines of sight that meet the
                            ///< surface need; else all, as figure 14 has it
    bool refine = false;    ///< find crossings below the step 1/L, to 1e-5 of it; else the step
                            ///< that is nearer in density, as figure 7 has it
};

/// What is seen at each place (x, y) of an M×M screen, stored at [y·M + x]: x and y are in steps
/// of 1/L voxel.
struct Screen {
    int size = 0;                        ///< M
    std::vector<float> depth;            ///< z, in voxels; infinite where nothing is seen
    std::vector<openvdb::Vec3f> normal;  ///< -∇f~, per voxel, not of length 1; 0 where nothing
};

/// Algorithm II: where each line of sight first enters {density > iso}, and the gradient there,
/// without the M³ array of densities. Working memory is N³ + N² + LN numbers (complex ones, of
/// which the density's being real halves the number); N² + LN of it for each thread.
///
/// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), section 3.2 and figure
/// 7, section 5.2 and figures 13 and 14, section 5.3. Derivatives use signed frequencies, where
/// the paper's listing multiplies the upper half by frequencies up to M. Lines of sight whose
/// largest possible density, the sum of the absolute frequencies along them, does not exceed the
/// iso-value are not searched if `onlySeen`; that is exact, and beyond the paper.
///
/// `count`, if given, receives what was multiplied. The result is the same for any number of
/// threads. Throws Error(ErrorKind::Usage) if L < 1 or M is too large or the iso-value is not
/// finite, Error(ErrorKind::Memory) before allocating, Error(ErrorKind::Interrupted).
template <typename Real>
Screen spectrumToScreen(const BasicSpectralVolume<Real>& volume, const ScreenOptions& options = {},
                        Progress& progress = silentProgress(), OperationCount* count = nullptr);

}  // namespace bandvox
