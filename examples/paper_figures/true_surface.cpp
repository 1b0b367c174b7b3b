#include "true_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace paper_figures {

namespace {

using openvdb::Vec3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Sphere final : public TrueSurface {
  public:
    NearestPoint nearest(const Vec3d& place) const override {
        const double radius = place.length();
        return {std::abs(radius - 1), place / radius, kInfinity};
    }
};

class Cube final : public TrueSurface {
  public:
    NearestPoint nearest(const Vec3d& place) const override {
        // The face is the one that the place is farthest out from, or least deep below.
        std::array<double, 3> out{};
        for (int a = 0; a < 3; ++a) out[a] = std::abs(place[a]);
        const int axis = static_cast<int>(std::max_element(out.begin(), out.end()) - out.begin());
        NearestPoint found{};
        found.normal[axis] = place[axis] < 0 ? -1 : 1;
        double square = std::pow(out[axis] - 1, 2);
        found.edgeDistance = kInfinity;
        for (const int a : {(axis + 1) % 3, (axis + 2) % 3}) {
            square += std::pow(std::max(0.0, out[a] - 1), 2);
            found.edgeDistance = std::min(found.edgeDistance, std::max(0.0, 1 - out[a]));
        }
        found.distance = std::sqrt(square);
        return found;
    }
};

// The side between the rims, and the discs at its ends.
class Hyperboloid final : public TrueSurface {
  public:
    explicit Hyperboloid(const HyperboloidRadii& radii) : mRadii(radii) {}

    NearestPoint nearest(const Vec3d& place) const override {
        // In the half plane of the place and the axis, by symmetry above the waist.
        const double r = std::hypot(place.x(), place.z());
        const double up = place.y() < 0 ? -1 : 1;
        const double y = std::abs(place.y());
        const Vec3d radial = r > 0 ? Vec3d(place.x() / r, 0, place.z() / r) : Vec3d(1, 0, 0);

        const double onSide = nearestHeight(r, y);
        const double side = std::hypot(mRadii.at(onSide) - r, onSide - y);
        const double onDisc = std::min(r, mRadii.rim);
        const double disc = std::hypot(onDisc - r, 1 - y);
        if (disc < side) return {disc, Vec3d(0, up, 0), mRadii.rim - onDisc};
        const double slopeSquare = mRadii.rim * mRadii.rim - mRadii.waist * mRadii.waist;
        const double leaning = slopeSquare * onSide / mRadii.at(onSide);
        return {side, (radial - Vec3d(0, up * leaning, 0)).unit(),
                std::hypot(mRadii.rim - mRadii.at(onSide), 1 - onSide)};
    }

  private:
    // The height 0 ≤ h ≤ 1 at which the side is nearest to (r, y): the best of a few, then by
    // golden sections.
    double nearestHeight(double r, double y) const {
        const auto square = [&](double h) {
            return std::pow(mRadii.at(h) - r, 2) + std::pow(h - y, 2);
        };
        constexpr int kPlaces = 16;
        double best = 0;
        for (int i = 1; i <= kPlaces; ++i) {
            const double h = static_cast<double>(i) / kPlaces;
            if (square(h) < square(best)) best = h;
        }
        double low = std::max(0.0, best - 1.0 / kPlaces);
        double high = std::min(1.0, best + 1.0 / kPlaces);
        constexpr double kGolden = 0.6180339887498949;
        while (high - low > 1e-10) {
            const double left = high - kGolden * (high - low);
            const double right = low + kGolden * (high - low);
            (square(left) < square(right) ? high : low) =
                square(left) < square(right) ? right : left;
        }
        return 0.5 * (low + high);
    }

    HyperboloidRadii mRadii;
};

class Placed final : public TrueSurface {
  public:
    Placed(SurfacePtr surface, const Placement& placement)
        : mSurface(std::move(surface)), mPlacement(placement) {}

    NearestPoint nearest(const Vec3d& place) const override {
        NearestPoint found = mSurface->nearest(mPlacement.toShape(place));
        found.distance *= mPlacement.scale;
        found.edgeDistance *= mPlacement.scale;
        found.normal = mPlacement.turn * found.normal;
        return found;
    }

  private:
    SurfacePtr mSurface;
    Placement mPlacement;
};

}  // namespace

double HyperboloidRadii::at(double y) const {
    return std::sqrt(waist * waist + (rim * rim - waist * waist) * y * y);
}

SurfacePtr sphereSurface() {
    return std::make_shared<Sphere>();
}
SurfacePtr cubeSurface() {
    return std::make_shared<Cube>();
}
SurfacePtr hyperboloidSurface(const HyperboloidRadii& radii) {
    return std::make_shared<Hyperboloid>(radii);
}
SurfacePtr placedSurface(SurfacePtr surface, const Placement& placement) {
    return std::make_shared<Placed>(std::move(surface), placement);
}

std::optional<double> firstHit(const TrueSurface& surface, const bandvox::Ray& ray,
                               double farthest) {
    // Nothing is nearer than the nearest point, so one may go as far as that.
    constexpr double kMet = 1e-9;
    for (double t = 0; t < farthest;) {
        const double distance = surface.nearest(ray.origin + t * ray.direction).distance;
        t += distance;
        if (distance < kMet) return t;
    }
    return std::nullopt;
}

}  // namespace paper_figures
