#include "source/row_intervals.h"

#include "source/ray_crossing.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace bandvox {

namespace {

std::vector<openvdb::BBoxd> boxesOf(const Mesh& mesh) {
    std::vector<openvdb::BBoxd> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (int k = 0; k < 3; ++k) boxes[i].expand(mesh.points[mesh.triangles[i][k]]);
    }
    return boxes;
}

}  // namespace

RowIntervals::RowIntervals(const Mesh& mesh) : mMesh(mesh), mTree(boxesOf(mesh)) {}

void RowIntervals::subtractFrom(std::span<const float> intervals, const Line& line,
                                std::vector<float>& rest) const {
    if (intervals.empty()) return;
    std::vector<std::pair<float, int>> crossings;
    const openvdb::Vec3d origin(std::numeric_limits<double>::lowest(), line.y, line.z);
    mTree.visitAlongX(origin, [&](std::uint32_t i) {
        const openvdb::Vec3I& t = mMesh.triangles[i];
        const auto crossing = lineCrossing(
            line.y, line.z, {mMesh.points[t[0]], mMesh.points[t[1]], mMesh.points[t[2]]});
        if (!crossing) return;
        crossings.emplace_back(static_cast<float>(crossing->x / line.voxelSize - line.xOrigin),
                               crossing->leaving);
    });
    std::sort(crossings.begin(), crossings.end());

    // Walk along both lists at a time.
    int winding = 0;
    bool isWithin = false, isRest = false;
    std::size_t i = 0, j = 0;
    while (i < intervals.size() || j < crossings.size()) {
        float x = 0;
        if (j == crossings.size() || (i < intervals.size() && intervals[i] <= crossings[j].first)) {
            x = intervals[i++];
            isWithin = !isWithin;
        } else {
            x = crossings[j].first;
            winding -= crossings[j++].second;
        }
        if (isRest == (isWithin && winding <= 0)) continue;
        isRest = !isRest;
        // Nothing is left between ends that coincide.
        if (!isRest && rest.back() == x) {
            rest.pop_back();
        } else {
            rest.push_back(x);
        }
    }
}

}  // namespace bandvox
