#include "source/winding_terms.h"

#include "core/instruction_sets.h"

#include <cmath>
#include <numbers>

namespace bandvox {

namespace {

using openvdb::Vec3d;

constexpr int kLanes = 16;

struct Place {
    float x, y, z;
};

// The angle of (x, y), off by less than 3e-7. Its odd polynomial is the best one of its degree for
// the arc tangent on [0, 1].
[[gnu::always_inline]] inline float angleOf(float y, float x) {
    const float ax = std::fabs(x), ay = std::fabs(y);
    const float large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    const float t = small / (large > 0 ? large : 1);
    const float s = t * t;
    float angle =
        t * (0.999996112F +
             s * (-0.33317368F +
                  s * (0.19807815F +
                       s * (-0.132333399F +
                            s * (0.0796236321F + s * (-0.0336041859F + s * 0.00681178189F))))));
    constexpr float kPi = std::numbers::pi_v<float>;
    angle = ay > ax ? kPi / 2 - angle : angle;
    angle = x < 0 ? kPi - angle : angle;
    return y < 0 ? -angle : angle;
}

// Half of the solid angles of kLanes triangles.
// A. van Oosterom, J. Strackee: "The Solid Angle of a Plane Triangle" (1983), eq. 8.
[[gnu::always_inline]] inline void addTriangles(const float* v, const Place& p, float* sum) {
    for (int l = 0; l < kLanes; ++l) {
        const float ax = v[l] - p.x, ay = v[kLanes + l] - p.y, az = v[2 * kLanes + l] - p.z;
        const float bx = v[3 * kLanes + l] - p.x, by = v[4 * kLanes + l] - p.y,
                    bz = v[5 * kLanes + l] - p.z;
        const float cx = v[6 * kLanes + l] - p.x, cy = v[7 * kLanes + l] - p.y,
                    cz = v[8 * kLanes + l] - p.z;
        const float a = std::sqrt(ax * ax + ay * ay + az * az);
        const float b = std::sqrt(bx * bx + by * by + bz * bz);
        const float c = std::sqrt(cx * cx + cy * cy + cz * cz);
        const float determinant =
            ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
        const float ab = ax * bx + ay * by + az * bz;
        const float bc = bx * cx + by * cy + bz * cz;
        const float ca = cx * ax + cy * ay + cz * az;
        sum[l] += angleOf(determinant, a * b * c + ab * c + bc * a + ca * b);
    }
}

// 4π times the winding numbers of kLanes groups (see WindingMoments).
[[gnu::always_inline]] inline void addGroups(const float* g, const Place& p, float* sum) {
    for (int l = 0; l < kLanes; ++l) {
        const auto n = [&](int i) { return g[i * kLanes + l]; };
        const float x = n(0) - p.x, y = n(1) - p.y, z = n(2) - p.z;
        const float xx = x * x, yy = y * y, zz = z * z;
        const float perSquare = 1 / (xx + yy + zz);
        const float perLength = std::sqrt(perSquare);
        const float zeroth = n(3) * x + n(4) * y + n(5) * z + n(6);
        const float quadratic =
            n(7) * xx + n(8) * yy + n(9) * zz + n(10) * (x * y) + n(11) * (x * z) + n(12) * (y * z);
        const float linear = n(13) * x + n(14) * y + n(15) * z;
        const float cubic = xx * (n(16) * x + n(19) * y + n(20) * z) +
                            yy * (n(17) * y + n(21) * x + n(22) * z) +
                            zz * (n(18) * z + n(23) * x + n(24) * y) + n(25) * (x * y * z);
        sum[l] += perSquare * perLength *
                  (zeroth + perSquare * (perSquare * cubic - 3 * quadratic - linear));
    }
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void sumTriangles(const float* blocks, int count, const Place& place, float* sum) {
    for (int i = 0; i < count; ++i) addTriangles(blocks + i * 9 * kLanes, place, sum);
}

BANDVOX_FOR_EACH_INSTRUCTION_SET
void sumGroups(const float* blocks, int count, const Place& place, float* sum) {
    for (int i = 0; i < count; ++i) addGroups(blocks + i * 26 * kLanes, place, sum);
}

// The place of number `number` of item `item` in a table whose items have so many.
std::size_t slot(int item, int number, int numbers) {
    return (static_cast<std::size_t>(item / kLanes) * numbers + number) * kLanes + item % kLanes;
}

double total(const std::array<float, kLanes>& sum) {
    double result = 0;
    for (const float s : sum) result += s;
    return result;
}

}  // namespace

void WindingTerms::begin(const Vec3d& origin, double unit) {
    static_assert(kTriangleNumbers == 9 && kGroupNumbers == 26);
    mOrigin = origin;
    mPerUnit = 1 / unit;
    mTriangles.clear();
    mGroups.clear();
    mTriangleCount = mGroupCount = 0;
}

void WindingTerms::addTriangle(const std::array<Vec3d, 3>& corner) {
    if (mTriangleCount % kLanes == 0) {
        mTriangles.resize(mTriangles.size() + kTriangleNumbers * kLanes, 0.0F);
    }
    for (int i = 0; i < 3; ++i) {
        const Vec3d at = (corner[i] - mOrigin) * mPerUnit;
        for (int axis = 0; axis < 3; ++axis) {
            mTriangles[slot(mTriangleCount, 3 * i + axis, kTriangleNumbers)] =
                static_cast<float>(at[axis]);
        }
    }
    ++mTriangleCount;
}

void WindingTerms::addGroup(const Vec3d& center, const WindingMoments::Coefficients& coefficients,
                            double scale) {
    if (mGroupCount % kLanes == 0) {
        mGroups.resize(mGroups.size() + kGroupNumbers * kLanes, 0.0F);
    }
    // The moments of order m go like a length to the power of 2 + m.
    const double ratio = scale * mPerUnit;
    const auto zeroth = static_cast<float>(ratio * ratio);
    const auto first = static_cast<float>(zeroth * ratio);
    const auto second = static_cast<float>(first * ratio);
    const Vec3d at = (center - mOrigin) * mPerUnit;
    const auto put = [&](int number, double value) {
        mGroups[slot(mGroupCount, number, kGroupNumbers)] = static_cast<float>(value);
    };
    for (int axis = 0; axis < 3; ++axis) put(axis, at[axis]);
    for (int i = 0; i < WindingMoments::kCoefficients; ++i) {
        put(3 + i, coefficients[i] * (i < 3 ? zeroth : i < 10 ? first : second));
    }
    ++mGroupCount;
}

void WindingTerms::finish() {
    // What fills up a block counts nothing: triangles that are points, groups far away of no size.
    for (int i = mGroupCount; i % kLanes != 0; ++i) {
        mGroups[slot(i, 0, kGroupNumbers)] = 1e6F;
    }
    for (int i = mTriangleCount; i % kLanes != 0; ++i) {
        for (int k = 0; k < 3; ++k) mTriangles[slot(i, 3 * k, kTriangleNumbers)] = 1e6F;
    }
}

double WindingTerms::at(const Vec3d& place) const {
    const Vec3d local = (place - mOrigin) * mPerUnit;
    const Place p{static_cast<float>(local.x()), static_cast<float>(local.y()),
                  static_cast<float>(local.z())};
    alignas(64) std::array<float, kLanes> angles{}, groups{};
    sumTriangles(mTriangles.data(), (mTriangleCount + kLanes - 1) / kLanes, p, angles.data());
    sumGroups(mGroups.data(), (mGroupCount + kLanes - 1) / kLanes, p, groups.data());
    return total(angles) / (2 * std::numbers::pi) + total(groups) / (4 * std::numbers::pi);
}

}  // namespace bandvox
