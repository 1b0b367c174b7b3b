#include "solids.h"

#include <bandvox/source/shapes.h>

#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace paper_figures {

using openvdb::Vec3d;

namespace {

// The paper does not give the proportions of its hyperboloid. The waist of the library's own,
// 0.3, is less than two of 8 voxels wide.
constexpr HyperboloidRadii kHyperboloid{0.5, 0.9};

class HyperboloidField final : public bandvox::FieldSource {
  public:
    std::string name() const override { return "hyperboloid"; }
    openvdb::BBoxd bounds() const override {
        return {Vec3d(-kHyperboloid.rim, -1, -kHyperboloid.rim),
                Vec3d(kHyperboloid.rim, 1, kHyperboloid.rim)};
    }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Vec3d p = start + static_cast<double>(i) * step;
            const bool isInside =
                std::abs(p.y()) <= 1 && std::hypot(p.x(), p.z()) <= kHyperboloid.at(p.y());
            values[i] = isInside ? 1.0F : 0.0F;
        }
    }
};

FieldPtr shape(const std::string& name) {
    return bandvox::makeShapeField("shape:" + name);
}

Solid solid(const std::string& name, FieldPtr field, SurfacePtr surface,
            const Placement& placement) {
    return {name, std::make_shared<PlacedField>(std::move(field), placement),
            placedSurface(std::move(surface), placement)};
}

}  // namespace

std::vector<Solid> solids(const Vec3d& move) {
    return {solid("hyperboloid", std::make_shared<HyperboloidField>(),
                  hyperboloidSurface(kHyperboloid), turned(0, -20, 0.95, move)),
            solid("sphere", shape("sphere"), sphereSurface(), turned(0, 0, 1, move)),
            solid("cube", shape("cube"), cubeSurface(), turned(30, -25, 0.75, move))};
}

FieldPtr twoBalls(double gap) {
    constexpr double kRadius = 0.48;
    const FieldPtr ball = shape("sphere");
    const auto at = [&](double x) {
        Placement placement;
        placement.scale = kRadius;
        placement.move = Vec3d(x, 0, 0);
        return std::make_shared<PlacedField>(ball, placement);
    };
    const double x = kRadius + gap / 2;
    return std::make_shared<UnionField>(std::vector<FieldPtr>{at(-x), at(x)});
}

FieldPtr tree() {
    return std::make_shared<PlacedField>(shape("tree"), turned(25, -10, 1.25));
}

}  // namespace paper_figures
