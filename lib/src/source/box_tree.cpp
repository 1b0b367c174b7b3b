#include "source/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace bandvox {
namespace {

constexpr std::uint32_t kLeafItems = 4;

}  // namespace

BoxTree::BoxTree(std::vector<openvdb::BBoxd> boxes)
    : mBoxes(std::move(boxes)), mItems(mBoxes.size()) {
    std::iota(mItems.begin(), mItems.end(), 0u);
    if (!mItems.empty()) build(0, static_cast<std::uint32_t>(mItems.size()));
}

void BoxTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t node = mNodes.size();
    mNodes.push_back({{}, begin, end, 0});
    for (std::uint32_t i = begin; i < end; ++i) mNodes[node].box.expand(mBoxes[mItems[i]]);
    if (end - begin <= kLeafItems) return;

    // Halve the items by their middles along the longest side; this ends however they lie.
    const auto axis = static_cast<int>(mNodes[node].box.maxExtent());
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(mItems.begin() + begin, mItems.begin() + middle, mItems.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double ma = mBoxes[a].min()[axis] + mBoxes[a].max()[axis];
                         const double mb = mBoxes[b].min()[axis] + mBoxes[b].max()[axis];
                         return std::pair(ma, a) < std::pair(mb, b);
                     });
    build(begin, middle);
    mNodes[node].right = static_cast<std::uint32_t>(mNodes.size());
    build(middle, end);
}

}  // namespace bandvox
