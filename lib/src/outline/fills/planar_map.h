#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bandvox {

/// A chain of straight segments on the page.
using PlanarChain = std::vector<std::array<double, 2>>;

/// How segments divide the plane. Each edge has two halves, one for the face at either side.
struct PlanarMap {
    struct HalfEdge {
        std::array<double, 2> start{};
        std::int32_t origin = 0;  ///< the number of the vertex where it starts
        std::int32_t twin = 0;    ///< the other half
        std::int32_t next = 0;    ///< that follows along the border of the face
        std::int32_t face = 0;    ///< on its left side, with y upward
        /// The segment that it is a part of: the one of lowest number if there are several.
        std::int32_t chain = 0, segment = 0;
        bool isForward = true;  ///< goes the way of that segment
    };
    std::vector<HalfEdge> halves;
    std::int32_t vertices = 0;
    std::int32_t faces = 0;
    std::int32_t outside = 0;  ///< the face without end
};

/// Divides the plane by chains, which may cross, touch and lie on each other. The structure is
/// that of exact arithmetic; new vertices, where segments cross, are rounded. Segments without
/// length are left out.
PlanarMap planarMap(std::span<const PlanarChain> chains);

}  // namespace bandvox
