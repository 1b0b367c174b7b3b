#include "source/box_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;

TEST(BoxTree, FindsWhatASlowSearchFinds) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::uniform_real_distribution<double> side(0.0, 0.3);
    for (const int count : {0, 1, 5, 100, 3000}) {
        std::vector<BBoxd> boxes;
        for (int i = 0; i < count; ++i) {
            const Vec3d p(coordinate(random), coordinate(random), coordinate(random));
            boxes.emplace_back(p, p + Vec3d(side(random), side(random), side(random)));
        }
        const BoxTree tree(boxes);
        for (int trial = 0; trial < 50; ++trial) {
            const Vec3d p(coordinate(random), coordinate(random), coordinate(random));
            std::set<std::uint32_t> found;
            tree.visitAlongX(p, [&](std::uint32_t i) { EXPECT_TRUE(found.insert(i).second); });
            for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                const BBoxd line(p, Vec3d(10.0, p.y(), p.z()));
                EXPECT_EQ(found.count(i) == 1, boxes[i].hasOverlap(line));
            }
        }
    }
}

TEST(BoxTree, TakesManyEqualBoxes) {
    const BoxTree tree(std::vector<BBoxd>(1000, BBoxd(Vec3d(0), Vec3d(1))));
    int found = 0;
    tree.visitAlongX(Vec3d(0.5), [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1000);
    tree.visitAlongX(Vec3d(1.5), [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1000);
}

}  // namespace
}  // namespace bandvox
