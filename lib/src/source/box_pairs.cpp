#include "source/box_pairs.h"

#include "core/instruction_sets.h"
#include "source/index_blocks.h"
#include "source/mesh_bounds.h"
#include "source/no_index.h"
#include "source/triangle_order.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace bandvox {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Boxes of a node of the tree.
constexpr std::size_t kChildren = 4;

}  // namespace

/// Finds, for each triangle of a leaf, the bits of those of another leaf that it makes a pair with.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void BoxPairs::findMeeting(const Leaf& a, const Leaf& b, const Box& boxOfB,
                           std::array<std::uint32_t, kLeaf>& meets) {
    const auto findBits = [](const Leaf& leaf, const float* low, const float* high) {
        std::uint32_t bits = 0;
        for (int k = 0; k < kLeaf; ++k) {
            const bool meet = (leaf.low[0][k] <= high[0]) & (leaf.high[0][k] >= low[0]) &
                              (leaf.low[1][k] <= high[1]) & (leaf.high[1][k] >= low[1]) &
                              (leaf.low[2][k] <= high[2]) & (leaf.high[2][k] >= low[2]);
            bits |= meet ? 1U << k : 0U;
        }
        return bits;
    };
    // Those of a leaf that have one of three settled corners.
    const auto findSettled = [](const Leaf& leaf, const std::uint32_t* corners) {
        std::uint32_t bits = 0;
        for (int k = 0; k < kLeaf; ++k) {
            bool same = false;
            for (const auto& settled : leaf.settled) {
                for (int j = 0; j < 3; ++j) same |= settled[k] == corners[j];
            }
            bits |= same ? 1U << k : 0U;
        }
        return bits;
    };
    meets.fill(0);
    std::uint32_t near = findBits(a, boxOfB.low.data(), boxOfB.high.data());
    for (; near != 0; near &= near - 1) {
        const int i = std::countr_zero(near);
        const float low[] = {a.low[0][i], a.low[1][i], a.low[2][i]};
        const float high[] = {a.high[0][i], a.high[1][i], a.high[2][i]};
        meets[i] = findBits(b, low, high);
        if (meets[i] == 0) continue;
        // The leaves have kNoIndex in place of all corners that are not settled, which are not the
        // same for that: here stands something else.
        std::uint32_t corners[3];
        for (int k = 0; k < 3; ++k) {
            corners[k] = a.settled[k][i] == kNoIndex ? kNoIndex - 1 : a.settled[k][i];
        }
        meets[i] &= ~findSettled(b, corners);
    }
}

BoxPairs::BoxPairs(const Mesh& mesh, const std::vector<std::uint8_t>& settled) {
    const std::vector<std::uint32_t> order = orderAlongCurve(mesh);
    // Relative to the middle, so that single precision is enough far from the origin, too.
    const openvdb::Vec3d middle =
        mesh.points.empty() ? openvdb::Vec3d(0.0) : boundsOf(mesh).getCenter();
    mLeaves.resize((order.size() + kLeaf - 1) / kLeaf);
    std::vector<Box> boxes(mLeaves.size());
    forEachIndex(mLeaves.size(), [&](std::size_t i) {
        Leaf& leaf = mLeaves[i];
        leaf.count = static_cast<int>(std::min<std::size_t>(kLeaf, order.size() - i * kLeaf));
        boxes[i] = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
        for (int k = 0; k < kLeaf; ++k) {
            Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
            leaf.triangle[k] = 0;
            for (auto& corner : leaf.settled) corner[k] = kNoIndex;
            if (k < leaf.count) {
                leaf.triangle[k] = order[i * kLeaf + k];
                const openvdb::Vec3I& t = mesh.triangles[leaf.triangle[k]];
                for (int corner = 0; corner < 3; ++corner) {
                    if (!settled.empty() && settled[t[corner]] != 0) {
                        leaf.settled[corner][k] = t[corner];
                    }
                    const openvdb::Vec3f p(mesh.points[t[corner]] - middle);
                    const std::array<float, 3> place = {p.x(), p.y(), p.z()};
                    box.expand({place, place});
                }
                boxes[i].expand(box);
            }
            for (int axis = 0; axis < 3; ++axis) {
                leaf.low[axis][k] = box.low[axis];
                leaf.high[axis][k] = box.high[axis];
            }
        }
    });
    mLevels.push_back(std::move(boxes));
    while (mLevels.back().size() > 1) {
        const std::vector<Box>& below = mLevels.back();
        std::vector<Box> level((below.size() + kChildren - 1) / kChildren);
        for (std::size_t i = 0; i < level.size(); ++i) {
            level[i] = below[i * kChildren];
            const std::size_t end = std::min((i + 1) * kChildren, below.size());
            for (std::size_t child = i * kChildren + 1; child < end; ++child) {
                level[i].expand(below[child]);
            }
        }
        mLevels.push_back(std::move(level));
    }
}

void BoxPairs::appendPairsOf(const Leaf& a, const Leaf& b, const Box& boxOfB,
                             std::vector<Pair>& pairs) {
    std::array<std::uint32_t, kLeaf> meets;
    findMeeting(a, b, boxOfB, meets);
    for (int i = 0; i < a.count; ++i) {
        std::uint32_t bits = meets[i];
        // Of a leaf with itself, each pair once.
        if (&a == &b) bits &= ~0U << (i + 1);
        for (; bits != 0; bits &= bits - 1) {
            pairs.emplace_back(a.triangle[i], b.triangle[std::countr_zero(bits)]);
        }
    }
}

void BoxPairs::appendPairs(std::size_t leaf, std::vector<Pair>& pairs) const {
    const Box& own = mLevels.front()[leaf];
    // Down the tree, from the left to the right, past what lies before the leaf or meets it not.
    std::size_t level = mLevels.size() - 1;
    std::size_t node = 0;
    std::size_t leavesOfNode = 1;  // at most
    for (std::size_t i = 0; i < level; ++i) leavesOfNode *= kChildren;
    while (true) {
        const bool isWanted = (node + 1) * leavesOfNode > leaf && mLevels[level][node].meets(own);
        if (isWanted && level > 0) {
            --level;
            leavesOfNode /= kChildren;
            node *= kChildren;
            continue;
        }
        if (isWanted) appendPairsOf(mLeaves[leaf], mLeaves[node], mLevels[0][node], pairs);
        ++node;
        while (level + 1 < mLevels.size() &&
               (node % kChildren == 0 || node == mLevels[level].size())) {
            node = (node + kChildren - 1) / kChildren;
            ++level;
            leavesOfNode *= kChildren;
        }
        if (node >= mLevels[level].size()) return;
    }
}

}  // namespace bandvox
