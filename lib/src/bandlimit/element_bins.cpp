#include "bandlimit/element_bins.h"

#include <algorithm>
#include <cmath>

namespace bandvox {

TileRange tilesTouching(const TileLayout& layout, int halo, int axis, double low, double high) {
    const double first = std::floor((low - halo - 1 - layout.origin[axis]) / layout.interior);
    const double last = std::floor((high + halo + 1 - layout.origin[axis]) / layout.interior);
    return {std::max(0, static_cast<int>(first)),
            std::min(layout.count[axis] - 1, static_cast<int>(last))};
}

ElementBins::ElementBins(const BoundarySource& source, const TileLayout& layout, int halo)
    : ElementBins(
          source.elementCount(), [&](std::size_t i) { return source.elementBounds(i); }, layout,
          halo) {}

ElementBins::ElementBins(std::size_t elementCount,
                         const std::function<openvdb::BBoxd(std::size_t)>& boundsOf,
                         const TileLayout& layout, int halo)
    : mZCount(layout.count.z()) {
    const auto forEachColumn = [&](std::size_t element, const auto& visit) {
        const openvdb::BBoxd bounds = boundsOf(element);
        const openvdb::Vec3d low = bounds.min() / layout.voxelSize;
        const openvdb::Vec3d high = bounds.max() / layout.voxelSize;
        const TileRange y = tilesTouching(layout, halo, 1, low.y(), high.y());
        const TileRange z = tilesTouching(layout, halo, 2, low.z(), high.z());
        for (int i = y.first; i <= y.last; ++i) {
            for (int j = z.first; j <= z.last; ++j) {
                visit(static_cast<std::size_t>(i) * mZCount + j);
            }
        }
    };
    mBins = sortIntoBins(
        elementCount, static_cast<std::size_t>(layout.count.y()) * layout.count.z(), forEachColumn);
}

std::span<const std::uint32_t> ElementBins::column(int y, int z) const {
    return mBins.bin(static_cast<std::size_t>(y) * mZCount + z);
}

}  // namespace bandvox
