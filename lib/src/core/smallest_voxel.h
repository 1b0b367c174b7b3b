#pragma once

namespace bandvox {

/// The least side of a voxel, world units: OpenVDB takes no transform that makes a volume of 1 less
/// than 3e-15.
constexpr double kSmallestVoxel = 1.443e-5;

}  // namespace bandvox
