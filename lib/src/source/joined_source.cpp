#include <bandvox/source/joined_source.h>

#include <algorithm>
#include <utility>

namespace bandvox {

JoinedSource::JoinedSource(std::string name, std::vector<const BoundarySource*> parts)
    : mName(std::move(name)), mParts(std::move(parts)), mStart(1, 0) {
    for (const BoundarySource* part : mParts) {
        mStart.push_back(mStart.back() + part->elementCount());
        mBounds.expand(part->bounds());
        mVolume += part->volume();
        mArea += part->area();
    }
}

std::size_t JoinedSource::partOf(std::size_t element) const {
    const auto next = std::upper_bound(mStart.begin(), mStart.end(), element);
    return static_cast<std::size_t>(next - mStart.begin()) - 1;
}

openvdb::BBoxd JoinedSource::elementBounds(std::size_t i) const {
    const std::size_t part = partOf(i);
    return mParts[part]->elementBounds(i - mStart[part]);
}

void JoinedSource::sampleElement(std::size_t i, const SamplingRegion& region,
                                 const SurfaceQuadrature& quadrature,
                                 std::vector<SurfaceSample>& samples) const {
    const std::size_t part = partOf(i);
    mParts[part]->sampleElement(i - mStart[part], region, quadrature, samples);
}

}  // namespace bandvox
