#pragma once

#include <string>
#include <vector>

namespace bandvox {

/// Where the normals of a picture come from.
///
/// All but the first are the older methods that section 2 of Chiba, Aoki, Saito: "A Voxel Based
/// Geometric Modeling" (1990) compares with its own. They see voxels, cubes that are solid where
/// the grid's value is at least iso, follow each line of sight to the first solid one, and show
/// stripes.
enum class Shading {
    Spectral,  ///< the gradient of the band-limited density
    Depth,     ///< none: the nearer, the brighter, over the depth of the object's box (figure 1)
    Phong,     ///< of the voxels' faces, averaged at their corners, interpolated (figure 2)
    Cross,     ///< differences of the depth buffer in the cross of four neighbours (figure 3)
    Sobel2d,   ///< Sobel's operator on the depth buffer (figure 4)
    Sobel3d,   ///< Sobel's operator on the 3 × 3 × 3 voxels around (figure 5)
};

/// A word for each, in their order: "spectral", "depth", "phong", "cross", "sobel2d", "sobel3d".
const std::vector<std::string>& shadingNames();

}  // namespace bandvox
