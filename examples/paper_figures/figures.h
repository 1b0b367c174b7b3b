#pragma once

#include "solids.h"

#include <filesystem>
#include <vector>

namespace paper_figures {

/// Figures 1 to 5: a solid in 64³ binary voxels, shaded by the five older methods; with the true
/// picture beside them.
void writeOlderMethods(const std::filesystem::path& folder, const Solid& solid);

/// Figure 8: solids by the paper's method, R = 64, N = 8, M = 64, under two lights.
void writeBandLimited(const std::filesystem::path& folder, const std::vector<Solid>& solids);

/// Figure 9: a solid by the paper's method, N = 16, M = 64, R = 16, 32 and 64.
void writeSampling(const std::filesystem::path& folder, const Solid& solid);

/// How large figure 10 is.
struct MeltingSize {
    int screen = 256;      ///< M; 128 or 256
    int treeVoxels = 128;  ///< N of the tree; 64 or 128
};

/// Figure 10: balls that melt together, and a tree with filleted branches.
void writeMelting(const std::filesystem::path& folder, const MeltingSize& size);

/// How far the normals are off, and how rough the shades are, of each solid by each method.
void writeMeasures(const std::filesystem::path& folder, const std::vector<Solid>& solids);

/// The mean errors of normals by the paper's method with other filters and other samples.
void writeVariants(const std::filesystem::path& folder);

}  // namespace paper_figures
