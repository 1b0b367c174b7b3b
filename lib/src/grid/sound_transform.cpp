#include "grid/sound_transform.h"

#include "core/words.h"

#include <openvdb/Exceptions.h>

#include <cmath>
#include <limits>

namespace bandvox {

namespace {

using openvdb::Vec3d;

constexpr double kLargest = 1e30;
constexpr double kSmallestVolume = 3e-15;

bool isWithin(const Vec3d& v, double largest) {
    return std::abs(v.x()) <= largest && std::abs(v.y()) <= largest && std::abs(v.z()) <= largest;
}

}  // namespace

std::string transformFault(const openvdb::math::Transform& transform) {
    if (!transform.isLinear()) return {};
    try {
        const Vec3d origin = transform.indexToWorld(Vec3d(0));
        if (!isWithin(origin, kLargest)) return "has a place that is not finite; expected numbers";
        // A file keeps the map, its inverse and the sides of voxels apart from each other.
        constexpr double kAgreement = 1e-3;
        constexpr double kUnits = 8;
        const double rounding = kUnits * std::numeric_limits<double>::epsilon() * origin.length();
        const Vec3d sides = transform.voxelSize();
        openvdb::Mat3d voxel;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d step(0);
            step[axis] = 1;
            const Vec3d along = transform.indexToWorld(step) - origin;
            const double side = along.length();
            if (!(side > 0 && side <= kLargest)) {
                return "has voxels with a side of " + inShort(side) +
                       " world units; expected more than 0 and up to 1e30";
            }
            voxel.setRow(axis, along);
            if (!(std::abs(sides[axis] - side) <= kAgreement * side + rounding)) {
                return "has voxels with a side of " + inShort(side) + " world units and of " +
                       inShort(sides[axis]) + " at once; expected one of them";
            }
            const Vec3d back = transform.worldToIndex(origin + along);
            if (!isWithin(back - step, kAgreement + rounding / side)) {
                return "has a transform whose inverse is another's, or none; expected its own";
            }
        }
        const double volume = std::abs(voxel.det());
        if (!(volume >= kSmallestVolume)) {
            return "has voxels of a volume of " + inShort(volume) + "; expected at least 3e-15";
        }
    } catch (const openvdb::Exception&) {
        return "has a transform that cannot be inverted; expected voxels of three directions";
    }
    return {};
}

}  // namespace bandvox
