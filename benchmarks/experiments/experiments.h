#pragma once

#include "table.h"

#include <bandvox/spectral/exponential_filter.h>

namespace bandvox::experiments {

/// The filters that are compared: one for each order, with as high a cutoff as leaves the lattice
/// less than 1e-4 that it cannot hold.
inline const ExponentialFilter kFilters[] = {{2, 0.16}, {4, 0.25}, {8, 0.35}};

/// The aliasing error of the sampled route against R/N, and against a sphere's radius.
void measureOversampling(const Folder& folder);

/// How far plates and balls move each other's surfaces.
void measureNearObjects(const Folder& folder);

/// Rounded corners and edges, and the thinnest parts that are left, against the cutoff.
void measureLostDetail(const Folder& folder);

/// The iso-value whose surface encloses the solid's volume.
void measureVolume(const Folder& folder);

/// The sampled route's true error against the one that it states, for solids of random size and
/// place.
void measureStatedError(const Folder& folder);

/// The error of a picture's normals.
void measureNormals(const Folder& folder);

/// How far surface voxels are from the true surface, by the threshold of their sub-samples, and how
/// far the surface of a band-limited density is.
void measureVoxelAccuracy(const Folder& folder);

/// The error and the cost of the winding number, and the errors of densities made by it.
void measureWinding(const Folder& folder);

/// The time that voxelization takes, by the methods that there are.
void measureVoxelTimes(const Folder& folder);

}  // namespace bandvox::experiments
