#include "render/facets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bandvox {

using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

LocalFrame::LocalFrame(const Vec3d& normal) : mZ(normal) {
    // T. Duff et al.: "Building an Orthonormal Basis, Revisited" (2017).
    const double sign = std::copysign(1.0, normal[2]);
    const double a = -1 / (sign + normal[2]);
    const double b = normal[0] * normal[1] * a;
    mX = Vec3d(1 + sign * normal[0] * normal[0] * a, sign * b, -sign * normal[0]);
    mY = Vec3d(b, sign + normal[1] * normal[1] * a, -normal[1]);
}

Facets::Facets(double roughness) : mAlpha(roughness > kSmallest ? roughness * roughness : 0) {}

double Facets::density(const Vec3d& half) const {
    const double square = mAlpha * mAlpha;
    const double spread = half[2] * half[2] * (square - 1) + 1;
    return square / (pi * spread * spread);
}

double Facets::shadowing(double cosine) const {
    const double c2 = cosine * cosine;
    return 0.5 * (std::sqrt(1 + mAlpha * mAlpha * std::max(1 - c2, 0.0) / c2) - 1);
}

double Facets::seenFromBoth(double cosOut, double cosIn) const {
    return 1 / (1 + shadowing(cosOut) + shadowing(cosIn));
}

double Facets::seenFromIn(double cosOut, double cosIn) const {
    if (areEven()) return 1;
    const double out = 1 + shadowing(cosOut);
    return out / (out + shadowing(cosIn));
}

Vec3d Facets::sample(const Vec3d& out, const Vec2d& u) const {
    if (areEven()) return {0, 0, 1};
    // Stretch the slopes to those of a hemisphere, take a place of its disk seen along `out`, and
    // shrink them again.
    const Vec3d view = Vec3d(mAlpha * out[0], mAlpha * out[1], out[2]).unit();
    const double across = view[0] * view[0] + view[1] * view[1];
    const Vec3d x =
        across > 1e-18 ? Vec3d(-view[1], view[0], 0) / std::sqrt(across) : Vec3d(1, 0, 0);
    const Vec3d y = view.cross(x);
    const double radius = std::sqrt(u[0]), angle = 2 * pi * u[1];
    const double p = radius * std::cos(angle);
    const double s = 0.5 * (1 + view[2]);
    const double q = (1 - s) * std::sqrt(std::max(1 - p * p, 0.0)) + s * radius * std::sin(angle);
    const Vec3d normal = p * x + q * y + std::sqrt(std::max(1 - p * p - q * q, 0.0)) * view;
    return Vec3d(mAlpha * normal[0], mAlpha * normal[1], std::max(normal[2], 1e-9)).unit();
}

double schlick(double straight, double cosine) {
    const double m = std::clamp(1 - cosine, 0.0, 1.0);
    return straight + (1 - straight) * m * m * m * m * m;
}

double fresnel(double cosine, double ratio) {
    const double sine2 = (1 - cosine * cosine) / (ratio * ratio);
    if (sine2 >= 1) return 1;
    const double behind = std::sqrt(1 - sine2);
    const double across = (cosine - ratio * behind) / (cosine + ratio * behind);
    const double along = (ratio * cosine - behind) / (ratio * cosine + behind);
    return 0.5 * (across * across + along * along);
}

bool refract(const Vec3d& out, const Vec3d& half, double ratio, Vec3d& direction) {
    const double cosine = out.dot(half);
    const double sine2 = (1 - cosine * cosine) / (ratio * ratio);
    if (sine2 >= 1) return false;
    direction = (cosine / ratio - std::sqrt(1 - sine2)) * half - out / ratio;
    return true;
}

CoatReflectance::CoatReflectance(const Facets& facets, double reflectance) {
    if (!(reflectance > 0)) return;
    // Average what sampled facets reflect. Towards the edge of the disk of facets, u_0 = 1, it
    // falls as a square root does: there places are closer to each other, and weigh less.
    constexpr int kSide = 32;
    for (int i = 0; i <= kSteps; ++i) {
        const double cosine = std::max(double(i) / kSteps, 1e-3);
        const Vec3d out(std::sqrt(1 - cosine * cosine), 0, cosine);
        double sum = 0;
        for (int s = 0; s < kSide * kSide; ++s) {
            const int first = s / kSide, second = s % kSide;
            const double inward = 1 - (first + 0.5) / kSide;
            const Vec3d half = facets.sample(out, {1 - inward * inward, (second + 0.5) / kSide});
            const Vec3d in = reflect(out, half);
            if (in[2] <= 0) continue;
            sum +=
                2 * inward * schlick(reflectance, out.dot(half)) * facets.seenFromIn(out[2], in[2]);
        }
        mCoat[i] = std::min(sum / (kSide * kSide), 1.0);
    }
    // E' = 2 ∫ E(μ) μ dμ of the straight pieces between the steps.
    double mean = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double a = double(i) / kSteps, b = double(i + 1) / kSteps, h = b - a;
        const double middle = 0.5 * (mCoat[i] + mCoat[i + 1]) * 0.5 * (a + b);
        mean += 2 * h * (mCoat[i] * a + 4 * middle + mCoat[i + 1] * b) / 6;
    }
    constexpr double kLeastGround = 1e-6;
    mScale = 1 - mean > kLeastGround ? 1 / (1 - mean) : 0;
}

double CoatReflectance::coat(double cosine) const {
    const double place = std::clamp(cosine, 0.0, 1.0) * kSteps;
    const int step = std::min(static_cast<int>(place), kSteps - 1);
    return mCoat[step] + (place - step) * (mCoat[step + 1] - mCoat[step]);
}

Vec2d placeInDisk(const Vec2d& u) {
    // P. Shirley, K. Chiu: "A Low Distortion Map Between Disk and Square" (1997).
    const double x = 2 * u[0] - 1, y = 2 * u[1] - 1;
    if (x == 0 && y == 0) return {0, 0};
    const bool wide = std::abs(x) > std::abs(y);
    const double radius = wide ? x : y;
    const double angle = wide ? pi / 4 * (y / x) : pi / 2 - pi / 4 * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

Vec3d cosineDirection(const Vec2d& u) {
    const Vec2d place = placeInDisk(u);
    return {place[0], place[1],
            std::sqrt(std::max(1 - place[0] * place[0] - place[1] * place[1], 0.0))};
}

}  // namespace bandvox
