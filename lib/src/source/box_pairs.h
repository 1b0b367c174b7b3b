#pragma once

#include <bandvox/source/mesh.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bandvox {

/// Finds the pairs of triangles of a mesh whose boxes, along the axes, meet, but for those of which
/// is known already what they are to each other.
///
/// The triangles are put along a curve that fills space, and so many that follow each other share a
/// leaf; above the leaves is a tree of boxes. Boxes are kept in single precision: rounding never
/// puts two coordinates into another order, so boxes that meet still do. A few that do not, may.
class BoxPairs {
  public:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    static constexpr int kLeaf = 16;

    /// `settled`, if not empty, has a number for each point of the mesh. Of triangles around a
    /// point whose number is not 0 all is known: they make no pair.
    explicit BoxPairs(const Mesh& mesh, const std::vector<std::uint8_t>& settled = {});

    std::size_t leafCount() const { return mLeaves.size(); }

    /// Appends, each once, the pairs of which the first is in this leaf and the second in it, too,
    /// or in a later one. Which of the two has the lower index is not said.
    void appendPairs(std::size_t leaf, std::vector<Pair>& pairs) const;

  private:
    struct Box {
        std::array<float, 3> low, high;
        bool meets(const Box& other) const {
            return low[0] <= other.high[0] && high[0] >= other.low[0] && low[1] <= other.high[1] &&
                   high[1] >= other.low[1] && low[2] <= other.high[2] && high[2] >= other.low[2];
        }
        void expand(const Box& other) {
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], other.low[axis]);
                high[axis] = std::max(high[axis], other.high[axis]);
            }
        }
    };
    struct alignas(64) Leaf {
        float low[3][kLeaf];
        float high[3][kLeaf];
        std::uint32_t settled[3][kLeaf];  // corners that are; kNoIndex in place of others
        std::uint32_t triangle[kLeaf];
        int count;
    };

    static void appendPairsOf(const Leaf& a, const Leaf& b, const Box& boxOfB,
                              std::vector<Pair>& pairs);
    static void findMeeting(const Leaf& a, const Leaf& b, const Box& boxOfB,
                            std::array<std::uint32_t, kLeaf>& meets);

    std::vector<Leaf> mLeaves;
    std::vector<std::vector<Box>> mLevels;  // of the tree, the leaves' boxes first
};

}  // namespace bandvox
