#include "solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox::experiments {

namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;

// What counts as on a face, world units (here a voxel, or not much less).
constexpr double kOnFace = 1e-9;
// How far before and behind a place HalfOnFaces looks: more than what counts as on a face.
constexpr double kAside = 1e-7;

}  // namespace

MeshSource Box::boundary() const {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d local((corner & 1) != 0 ? half.x() : -half.x(),
                          (corner & 2) != 0 ? half.y() : -half.y(),
                          (corner & 4) != 0 ? half.z() : -half.z());
        mesh.points.push_back(rotation * local + center);
    }
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : kFaces) {
        mesh.triangles.emplace_back(face[0], face[1], face[2]);
        mesh.triangles.emplace_back(face[0], face[2], face[3]);
    }
    return {"box", std::move(mesh)};
}

BoxField::BoxField(const Box& box)
    : mBox(box), mBack(box.rotation.transpose()), mBounds(box.boundary().bounds()) {}

void BoxField::sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const {
    // The row is inside for an interval of its parameter, the meeting of three slabs.
    const Vec3d from = toLocal(start - mBox.center);
    const Vec3d slope = toLocal(step);
    double low = 0;
    double high = static_cast<double>(values.size()) - 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = mBox.half[axis] + kOnFace;
        if (std::abs(slope[axis]) < kOnFace) {
            if (std::abs(from[axis]) > half) high = -1;
            continue;
        }
        const double a = (-half - from[axis]) / slope[axis];
        const double b = (half - from[axis]) / slope[axis];
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
    }
    std::fill(values.begin(), values.end(), 0.0F);
    for (auto i = static_cast<std::int64_t>(std::ceil(low)); double(i) <= high; ++i) values[i] = 1;
}

std::optional<float> BoxField::constantIn(const BBoxd& box) const {
    const Vec3d center = toLocal(0.5 * (box.min() + box.max()) - mBox.center);
    const Vec3d extent = 0.5 * (box.max() - box.min());
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis) {
        double reach = 2 * kOnFace;
        for (int i = 0; i < 3; ++i) reach += std::abs(mBack(axis, i)) * extent[i];
        if (std::abs(center[axis]) - reach > mBox.half[axis]) return 0.0F;
        isInside = isInside && std::abs(center[axis]) + reach < mBox.half[axis];
    }
    return isInside ? std::optional(1.0F) : std::nullopt;
}

std::optional<float> HalfOnFaces::constantIn(const BBoxd& box) const {
    return mField.constantIn({box.min() - Vec3d(kAside), box.max() + Vec3d(kAside)});
}

void HalfOnFaces::sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const {
    thread_local std::vector<float> behind;
    behind.resize(values.size());
    mField.sampleRow(start - Vec3d(kAside), step, values);
    mField.sampleRow(start + Vec3d(kAside), step, behind);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5F * (values[i] + behind[i]);
}

BBoxd ShiftedCopies::bounds() const {
    BBoxd bounds;
    const BBoxd one = mSource.bounds();
    for (const Vec3d& shift : mShifts) {
        bounds.expand(BBoxd(one.min() + shift, one.max() + shift));
    }
    return bounds;
}

BBoxd ShiftedCopies::elementBounds(std::size_t i) const {
    const BBoxd bounds = mSource.elementBounds(i % mSource.elementCount());
    const Vec3d& shift = mShifts[i / mSource.elementCount()];
    return {bounds.min() + shift, bounds.max() + shift};
}

void ShiftedCopies::sampleElement(std::size_t i, const SamplingRegion& region,
                                  const SurfaceQuadrature& quadrature,
                                  std::vector<SurfaceSample>& samples) const {
    SamplingRegion seen = region;
    seen.origin -= mShifts[i / mSource.elementCount()] / region.voxelSize;
    mSource.sampleElement(i % mSource.elementCount(), seen, quadrature, samples);
}

}  // namespace bandvox::experiments
