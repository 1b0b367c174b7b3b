#pragma once

#include <bandvox/source/bezier_patch.h>

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandvox {

/// A side of a patch that none other shares, in the direction in which the surface lies to its
/// left.
struct OpenSide {
    std::uint32_t component;
    std::uint32_t from, to;                      ///< ids of its ends
    std::vector<std::array<double, 4>> control;  ///< as those of a patch
};

/// Patches joined at the sides that they share.
struct JoinedPatches {
    std::size_t components = 0;
    std::vector<std::uint32_t> ofPatch;  ///< the component of each patch
    std::vector<OpenSide> open;
    std::size_t sharedByMore = 0;  ///< groups of more than two patches that share a side
    std::size_t flipped = 0;       ///< patches turned to agree with their neighbours
    std::size_t oneSided = 0;      ///< components that cannot be oriented
};

/// Finds which sides coincide as curves with the same parameters, to within `tolerance` (world
/// units), and turns patches so that neighbours agree, the fewer of each component. Sides shorter
/// than that are none.
JoinedPatches joinPatches(std::vector<BezierPatch>& patches, double tolerance);

/// The same patch seen from its other side.
BezierPatch turned(const BezierPatch& patch);

/// Takes the open sides of each component apart into loops.
std::vector<std::vector<OpenSide>> findLoops(const std::vector<OpenSide>& open);

/// The point of a curve of homogeneous control points.
openvdb::Vec3d curvePoint(std::vector<std::array<double, 4>> control, double t);

}  // namespace bandvox
