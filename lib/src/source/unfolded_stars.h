#pragma once

#include <bandvox/source/mesh.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// What is certain about the sides that triangles face: of each, bit 2·axis is set if its normal
/// has a positive part along the axis, bit 2·axis + 1 if it has a negative one. A triangle with
/// any bit has an area.
std::vector<std::uint8_t> certainFacings(const Mesh& mesh);

/// For each point 1 if no two of the triangles around it have more in common than the point and
/// edges from it, for certain; 0 if that is not so, or not known.
///
/// It is known where the triangles, as they follow each other around the point, come back to the
/// first after one turn, and all face the same way along an axis: seen along it they then lie side
/// by side. `facings`: those of certainFacings.
std::vector<std::uint8_t> findUnfoldedStars(const Mesh& mesh,
                                            const std::vector<std::uint8_t>& facings);

}  // namespace bandvox
