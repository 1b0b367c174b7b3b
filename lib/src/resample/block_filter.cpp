#include "resample/block_filter.h"

#include "resample/gaussian_block_filter.h"
#include "resample/spectral_block_filter.h"

#include <cmath>

namespace bandvox {

double LatticeFilter::operator()(const LatticeMap& map, const openvdb::Vec3d& k) const {
    if (!kept) return 1;
    const double wanted = (*kept)(map.frequency(k));
    if (!before) return wanted;
    const double there = (*before)(k.length());
    return wanted >= kHighestGain * there ? kHighestGain : wanted / there;
}

int LatticeFilter::reach(const LatticeMap& map) const {
    constexpr double kReachShare = 1.0 / 4;
    if (!kept) return 0;
    return static_cast<int>(
        std::ceil(filterReach(*kept, kReachShare * tolerance) * map.coarsest()));
}

openvdb::CoordBBox BlockFilter::sourceBox(const openvdb::Coord& block) const {
    const openvdb::Vec3d first = block.asVec3d() * mBlockSide;
    const openvdb::BBoxd places =
        mMap.toSource(openvdb::BBoxd(first, first + openvdb::Vec3d(mBlockSide - 1)));
    openvdb::CoordBBox box(openvdb::Coord::floor(places.min()), openvdb::Coord::ceil(places.max()));
    box.expand(mReach);
    return box;
}

std::unique_ptr<BlockFilter> makeBlockFilter(const LatticeMap& map, const LatticeFilter& filter) {
    if (GaussianBlockFilter::isFor(map, filter)) {
        return std::make_unique<GaussianBlockFilter>(map, filter);
    }
    return std::make_unique<SpectralBlockFilter>(map, filter);
}

}  // namespace bandvox
