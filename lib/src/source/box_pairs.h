#pragma once

#include <bandvox/source/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace bandvox {

/// Finds the pairs of triangles of a mesh whose boxes, along the axes, meet.
///
/// The triangles are put along a curve that fills space, and so many that follow each other share a
/// leaf; above the leaves is a tree of boxes. Boxes are kept in single precision: rounding never
/// puts two coordinates into another order, so boxes that meet still do. A few that do not, may.
class BoxPairs {
  public:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;
    static constexpr int kLeaf = 16;

    explicit BoxPairs(const Mesh& mesh);

    std::size_t leafCount() const { return mLeaves.size(); }

    /// Appends, each once, the pairs of which the first is in this leaf and the second in it, too,
    /// or in a later one. Which of the two has the lower index is not said.
    void appendPairs(std::size_t leaf, std::vector<Pair>& pairs) const;

  private:
    struct Box {
        std::array<float, 3> low, high;
        bool meets(const Box& other) const;
        void expand(const Box& other);
    };
    struct alignas(64) Leaf {
        float low[3][kLeaf];
        float high[3][kLeaf];
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
