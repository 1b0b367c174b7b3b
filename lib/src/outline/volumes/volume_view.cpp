#include "outline/volumes/volume_view.h"

#include <cmath>
#include <cstddef>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using Row = std::array<double, 4>;

double rowOf(const Row& row, const Vec3d& p) {
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
}
double linearRow(const Row& row, const Vec3d& p) {
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
}

// What all three rows map to 0: the eye, homogeneous, or the direction to it.
Row kernelOf(const Row& a, const Row& b, const Row& c) {
    Row kernel{};
    for (std::size_t left = 0; left < 4; ++left) {
        std::array<std::size_t, 3> k{};
        std::size_t n = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if (i != left) k[n++] = i;
        }
        const double minor = a[k[0]] * (b[k[1]] * c[k[2]] - b[k[2]] * c[k[1]]) -
                             a[k[1]] * (b[k[0]] * c[k[2]] - b[k[2]] * c[k[0]]) +
                             a[k[2]] * (b[k[0]] * c[k[1]] - b[k[1]] * c[k[0]]);
        kernel[left] = left % 2 == 0 ? minor : -minor;
    }
    return kernel;
}

}  // namespace

VolumeView::VolumeView(const ViewMatrix& view, const openvdb::Mat4d& indexToWorld,
                       const Vec3d& middle)
    : mRows{} {
    // OpenVDB multiplies rows with matrices, whose last row is a translation.
    openvdb::Mat4d columns;
    for (int r = 0; r < 4; ++r) {
        for (int k = 0; k < 4; ++k) {
            double sum = 0;
            for (int c = 0; c < 4; ++c) {
                sum += view[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] *
                       indexToWorld(k, c);
            }
            mRows[static_cast<std::size_t>(r)][static_cast<std::size_t>(k)] = sum;
            columns(k, r) = sum;
        }
    }
    mBack = columns.inverse(0);
    const Row eye = kernelOf(mRows[0], mRows[1], mRows[3]);
    const Vec3d place(eye[0], eye[1], eye[2]);
    const double farthest = place.length() + std::abs(eye[3]) * middle.length();
    // What is 0 but for rounding is 0.
    constexpr double kParallel = 1e-12;
    mSpread = std::abs(eye[3]) * (1 + middle.length()) > kParallel * farthest ? eye[3] : 0;
    mSight = -place;
    const Vec3d ahead = sight(middle);
    const double w = rowOf(mRows[3], middle), z = rowOf(mRows[2], middle) / w;
    const double deeper = (linearRow(mRows[2], ahead) - z * linearRow(mRows[3], ahead)) / w;
    const double scale = (deeper < 0 ? -1 : 1) / ahead.length();
    mSpread *= scale;
    mSight *= scale;
}

Vec3d VolumeView::place(const Vec3d& index) const {
    const double w = rowOf(mRows[3], index);
    return Vec3d(rowOf(mRows[0], index), rowOf(mRows[1], index), rowOf(mRows[2], index)) / w;
}

Vec3d VolumeView::placeOf(const Vec3d& seen) const {
    return mBack.transformH(seen);
}

std::array<double, 2> VolumeView::move(const Vec3d& index, const Vec3d& by) const {
    const double w = rowOf(mRows[3], index), dw = linearRow(mRows[3], by);
    const auto along = [&](const Row& row) {
        return (linearRow(row, by) - rowOf(row, index) / w * dw) / w;
    };
    return {along(mRows[0]), along(mRows[1])};
}

Vec3d VolumeView::start(const Vec3d& index, double far) const {
    if (mSpread != 0) return mSight / -mSpread;
    return index - far * mSight;
}

}  // namespace bandvox
