#include "placed_field.h"

#include <openvdb/math/Mat.h>

#include <algorithm>
#include <numbers>
#include <utility>

namespace paper_figures {

using openvdb::Vec3d;

Placement turned(double azimuth, double tilt, double scale, const Vec3d& move) {
    constexpr double kDegree = std::numbers::pi / 180;
    return {openvdb::math::rotation<openvdb::Mat3d>(openvdb::math::X_AXIS, tilt * kDegree) *
                openvdb::math::rotation<openvdb::Mat3d>(openvdb::math::Y_AXIS, azimuth * kDegree),
            scale, move};
}

PlacedField::PlacedField(FieldPtr field, const Placement& placement)
    : mField(std::move(field)), mPlacement(placement) {
    const openvdb::BBoxd box = mField->bounds();
    for (int i = 0; i < 8; ++i) {
        mBounds.expand(mPlacement.toWorld({(i & 1 ? box.max() : box.min())[0],
                                           (i & 2 ? box.max() : box.min())[1],
                                           (i & 4 ? box.max() : box.min())[2]}));
    }
}

void PlacedField::sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const {
    const Vec3d first = mPlacement.toShape(start);
    mField->sampleRow(first, mPlacement.toShape(start + step) - first, values);
}

UnionField::UnionField(std::vector<FieldPtr> fields) : mFields(std::move(fields)) {
    for (const FieldPtr& field : mFields) {
        mBounds.expand(field->bounds().min());
        mBounds.expand(field->bounds().max());
    }
}

void UnionField::sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const {
    std::fill(values.begin(), values.end(), 0.0F);
    std::vector<float> row(values.size());
    for (const FieldPtr& field : mFields) {
        field->sampleRow(start, step, row);
        std::transform(row.begin(), row.end(), values.begin(), values.begin(),
                       [](float a, float b) { return std::max(a, b); });
    }
}

}  // namespace paper_figures
