#pragma once

#include "outline/drawing/curve_scene.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace bandvox::outline_test {

/// A scene of curves that are their own chords, with a function for what is seen. A curve's point
/// is on the side of a fold that the sign of its u tells. `pace`: of the share of a chord, the
/// power that is the share of its length; 2 for one that begins at a cusp.
class PlainScene final : public CurveScene {
  public:
    using Seen = std::function<SeenSurface(double x, double y)>;
    explicit PlainScene(
        Seen seen = [](double, double) { return SeenSurface(); }, double pace = 1)
        : mSeen(std::move(seen)), mPace(pace) {}

    std::unique_ptr<CurveReader> reader() const override {
        return std::make_unique<Reader>(mSeen, mPace);
    }

  private:
    class Reader final : public CurveReader {
      public:
        Reader(const Seen& seen, double pace) : mSeen(seen), mPace(pace) {}

        CurvePoint between(const CurvePoint& a, const CurvePoint& b, double along) override {
            const double share = std::pow(along, mPace);
            CurvePoint p = a;
            p.x += share * (b.x - a.x);
            p.y += share * (b.y - a.y);
            p.z += share * (b.z - a.z);
            p.u += share * (b.u - a.u);
            p.corner = false;
            return p;
        }
        int countBefore(const CurvePoint&) override { return 0; }
        double foldAt(const CurvePoint& point, bool) override { return point.u; }
        SeenSurface seenAt(double x, double y) override { return mSeen(x, y); }
        double cosineAt(const CurvePoint&) override { return 0; }

      private:
        const Seen& mSeen;
        double mPace;
    };

    Seen mSeen;
    double mPace;
};

/// A curve through places x, y, z of the page; a closed one if the last place is the first.
inline Curve chainOf(const std::vector<std::array<double, 3>>& places,
                     OutlineKind kind = OutlineKind::Contour) {
    Curve curve{.kind = kind};
    for (const auto& [x, y, z] : places) {
        CurvePoint p;
        p.x = x;
        p.y = y;
        p.z = z;
        curve.points.push_back(p);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, places.size() - 1);
        const double dx = places[b][0] - places[a][0], dy = places[b][1] - places[a][1];
        const double length = std::hypot(dx, dy);
        if (!(length > 0)) continue;
        curve.points[i].tx = dx / length;
        curve.points[i].ty = dy / length;
    }
    curve.closed = places.size() > 2 && places.front() == places.back();
    return curve;
}

}  // namespace bandvox::outline_test
