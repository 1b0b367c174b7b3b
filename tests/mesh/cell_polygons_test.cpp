#include "mesh/cell_polygons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <vector>

namespace bandvox::mesh_test {
namespace {

using openvdb::Vec3d;

int upperCorner(int edge) {
    return lowerCorner(edge) | 1 << edge / 4;
}

Vec3d middle(int edge) {
    const auto place = [](int corner) { return Vec3d(corner & 1, corner >> 1 & 1, corner >> 2); };
    return 0.5 * (place(lowerCorner(edge)) + place(upperCorner(edge)));
}

// The face of the cell in which two edges lie, or -1.
int commonFace(int a, int b) {
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            const double plane = side;
            if (middle(a)[axis] == plane && middle(b)[axis] == plane) return 2 * axis + side;
        }
    }
    return -1;
}

// Calls visit(inside, joined) for every way in which the surface may meet a cell.
template <typename Visit>
void forEachCase(const Visit& visit) {
    for (unsigned inside = 0; inside < 256; ++inside) {
        const unsigned ambiguous = facesToDecide(inside);
        for (unsigned joined = 0; joined < 64; ++joined) {
            if ((joined & ~ambiguous) == 0) visit(inside, joined);
        }
    }
}

TEST(CellPolygons, EdgesLieWhereTheyAreSaidTo) {
    std::set<std::pair<int, int>> all;
    for (int edge = 0; edge < 12; ++edge) {
        EXPECT_EQ(upperCorner(edge) ^ lowerCorner(edge), 1 << edge / 4);
        all.emplace(lowerCorner(edge), upperCorner(edge));
    }
    EXPECT_EQ(all.size(), 12u);
    EXPECT_EQ(facesToDecide(0b00000001), 0u);
    EXPECT_EQ(facesToDecide(0b00001001), 1u << 4);  // across the lower face along z
    EXPECT_EQ(facesToDecide(0b01101001), 63u);
}

TEST(CellPolygons, EachCrossedEdgeIsInOneRingOnce) {
    forEachCase([](unsigned inside, unsigned joined) {
        const CellPolygons polygons = traceCell(inside, joined);
        std::set<int> seen;
        int end = 0;
        for (int r = 0; r < polygons.rings; ++r) {
            ASSERT_GE(polygons.sizes[r], 3);
            for (int k = 0; k < polygons.sizes[r]; ++k) {
                ASSERT_TRUE(seen.insert(polygons.edges[end + k]).second);
                const int next = polygons.edges[end + (k + 1) % polygons.sizes[r]];
                ASSERT_GE(commonFace(polygons.edges[end + k], next), 0);
            }
            end += polygons.sizes[r];
        }
        for (int edge = 0; edge < 12; ++edge) {
            const bool crossed =
                (inside >> lowerCorner(edge) & 1) != (inside >> upperCorner(edge) & 1);
            ASSERT_EQ(seen.contains(edge), crossed);
        }
    });
}

TEST(CellPolygons, RingsTurnOutward) {
    // A corner alone inside is cut off by a triangle that faces away from it.
    for (int corner = 0; corner < 8; ++corner) {
        for (const bool isHole : {false, true}) {
            const unsigned inside = isHole ? 0xFF & ~(1U << corner) : 1U << corner;
            const CellPolygons polygons = traceCell(inside, 0);
            ASSERT_EQ(polygons.rings, 1);
            ASSERT_EQ(polygons.sizes[0], 3);
            const Vec3d a = middle(polygons.edges[0]), b = middle(polygons.edges[1]);
            const Vec3d c = middle(polygons.edges[2]);
            const Vec3d normal = (b - a).cross(c - a);
            const Vec3d place(corner & 1, corner >> 1 & 1, corner >> 2);
            EXPECT_GT((isHole ? -1 : 1) * normal.dot(a - place), 0);
        }
    }
}

TEST(CellPolygons, JoinedCornersAreOnOneSide) {
    // Two corners across a face: apart they are two triangles, joined one ring around both.
    EXPECT_EQ(traceCell(0b00001001, 0).rings, 2);
    const CellPolygons joined = traceCell(0b00001001, 1U << 4);
    EXPECT_EQ(joined.rings, 1);
    EXPECT_EQ(joined.sizes[0], 6);
    // All corners in turn: four apart, and one ring where all faces join them.
    EXPECT_EQ(traceCell(0b01101001, 0).rings, 4);
    EXPECT_EQ(traceCell(0b01101001, 63).rings, 4);  // around those outside
}

// A diagonal in a face that two cells share would be an edge of four triangles if both had it.
TEST(CellPolygons, DiagonalsInFacesBelongToTheCellBelow) {
    std::map<int, int> uncut;
    forEachCase([&](unsigned inside, unsigned joined) {
        const CellPolygons polygons = traceCell(inside, joined);
        const std::uint8_t* ring = polygons.edges.data();
        for (int r = 0; r < polygons.rings; ring += polygons.sizes[r++]) {
            const int size = polygons.sizes[r];
            std::vector<Vec3d> places;
            for (int k = 0; k < size; ++k) places.push_back(middle(ring[k]));
            std::vector<openvdb::Vec3I> triangles;
            if (!cutRing({ring, static_cast<std::size_t>(size)}, places, triangles)) {
                EXPECT_TRUE(triangles.empty());
                ++uncut[size];
                continue;
            }
            ASSERT_EQ(triangles.size(), static_cast<std::size_t>(size - 2));
            std::multiset<std::pair<int, int>> sides;
            for (const openvdb::Vec3I& t : triangles) {
                for (int k = 0; k < 3; ++k) {
                    sides.emplace(static_cast<int>(t[k]), static_cast<int>(t[(k + 1) % 3]));
                }
            }
            for (const auto& [a, b] : sides) {
                ASSERT_EQ(sides.count({a, b}), 1u);
                if (b == (a + 1) % size) continue;
                ASSERT_EQ(sides.count({b, a}), 1u);
                const int face = commonFace(ring[a], ring[b]);
                ASSERT_TRUE(face < 0 || face % 2 == 1) << "ring of " << size;
            }
        }
    });
    EXPECT_EQ(uncut, (std::map<int, int>{{9, 12}}));
}

}  // namespace
}  // namespace bandvox::mesh_test
