#include "source/patch_source.h"
#include "source/revolution_patch.h"
#include "source/shape_tree.h"
#include "source/solid_formula.h"

#include <bandvox/core/error.h>
#include <bandvox/source/shapes.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Vec3d;
using std::numbers::pi;

constexpr std::string_view kPrefix = "shape:";

constexpr double kHyperboloidWaist = 0.3;
constexpr double kHyperboloidRim = 0.8;
constexpr double kTorusTube = 0.3;               ///< radius of the tube
constexpr double kTorusRing = 1.0 - kTorusTube;  ///< radius of the tube's middle line
constexpr double kBallGap = 0.06;                ///< between the two balls
constexpr double kBallRadius = 0.25 * (2.0 - kBallGap);
constexpr double kBallCenter = 1.0 - kBallRadius;  ///< on the x axis, either side

/// Turning slope of the hyperbola's asymptote: r² = waist² + slope²·y² is the rim at y = 1.
double hyperboloidSlope() {
    return std::sqrt(kHyperboloidRim * kHyperboloidRim - kHyperboloidWaist * kHyperboloidWaist);
}

/// A shape's surface, and the same as a formula.
struct Shape {
    std::string name;
    std::function<std::unique_ptr<BoundarySource>(std::string)> boundary;
    std::function<std::unique_ptr<SolidFormula>()> formula;
};

std::unique_ptr<BoundarySource> makeHyperboloid(std::string name) {
    const double waist = kHyperboloidWaist;
    const double rim = kHyperboloidRim;
    const double slope = hyperboloidSlope();
    PatchList patches;
    const Vec3d origin(0.0);
    appendRevolution(std::make_shared<LineProfile>(0.0, -1.0, rim, -1.0), origin, patches);
    appendRevolution(std::make_shared<HyperbolaProfile>(waist, slope, -1.0, 0.0), origin, patches);
    appendRevolution(std::make_shared<HyperbolaProfile>(waist, slope, 0.0, 1.0), origin, patches);
    appendRevolution(std::make_shared<LineProfile>(rim, 1.0, 0.0, 1.0), origin, patches);

    // The side's area is 4π ∫ sqrt(waist² + q²·y²) dy from 0 to 1.
    const double volume = 2.0 * pi * (waist * waist + slope * slope / 3.0);
    const double q = slope * std::hypot(1.0, slope);
    const double side =
        2.0 * pi * (std::hypot(waist, q) + waist * waist / q * std::asinh(q / waist));
    return std::make_unique<PatchSource>(std::move(name), std::move(patches), volume,
                                         side + 2.0 * pi * rim * rim);
}

void appendSphere(const Vec3d& center, double radius, PatchList& patches) {
    for (const double from : {-0.5 * pi, 0.0}) {
        appendRevolution(std::make_shared<ArcProfile>(0.0, 0.0, radius, from, from + 0.5 * pi),
                         center, patches);
    }
}

double sphereVolume(double radius) {
    return 4.0 / 3.0 * pi * radius * radius * radius;
}
double sphereArea(double radius) {
    return 4.0 * pi * radius * radius;
}

std::unique_ptr<BoundarySource> makeSphere(std::string name) {
    PatchList patches;
    appendSphere(Vec3d(0.0), 1.0, patches);
    return std::make_unique<PatchSource>(std::move(name), std::move(patches), sphereVolume(1.0),
                                         sphereArea(1.0));
}

std::unique_ptr<BoundarySource> makeTwoBalls(std::string name) {
    PatchList patches;
    appendSphere(Vec3d(-kBallCenter, 0.0, 0.0), kBallRadius, patches);
    appendSphere(Vec3d(kBallCenter, 0.0, 0.0), kBallRadius, patches);
    return std::make_unique<PatchSource>(std::move(name), std::move(patches),
                                         2.0 * sphereVolume(kBallRadius),
                                         2.0 * sphereArea(kBallRadius));
}

std::unique_ptr<BoundarySource> makeTorus(std::string name) {
    PatchList patches;
    for (int quarter = 0; quarter < 4; ++quarter) {
        appendRevolution(std::make_shared<ArcProfile>(kTorusRing, 0.0, kTorusTube,
                                                      0.5 * pi * quarter, 0.5 * pi * (quarter + 1)),
                         Vec3d(0.0), patches);
    }
    return std::make_unique<PatchSource>(std::move(name), std::move(patches),
                                         2.0 * pi * pi * kTorusRing * kTorusTube * kTorusTube,
                                         4.0 * pi * pi * kTorusRing * kTorusTube);
}

std::unique_ptr<BoundarySource> makeCube(std::string name) {
    PatchList patches;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            // Walk about the face so that it is seen counter-clockwise from outside.
            Vec3d center(0.0);
            Vec3d e1(0.0);
            Vec3d e2(0.0);
            center[axis] = side;
            e1[(axis + 1) % 3] = side;
            e2[(axis + 2) % 3] = 1.0;
            patches.push_back(std::make_unique<QuadPatch>(center - e1 - e2, center + e1 - e2,
                                                          center + e1 + e2, center - e1 + e2));
        }
    }
    return std::make_unique<PatchSource>(std::move(name), std::move(patches), 8.0, 24.0);
}

const TreeShape& tree() {
    static const TreeShape shape;
    return shape;
}

std::unique_ptr<BoundarySource> makeTree(std::string name) {
    PatchList patches;
    const double area = tree().appendPatches(patches);
    return std::make_unique<PatchSource>(std::move(name), std::move(patches), tree().volume(),
                                         area);
}

std::unique_ptr<SolidFormula> sphereFormula() {
    return std::make_unique<BallsFormula>(std::vector{Vec3d(0.0)}, 1.0);
}

std::unique_ptr<SolidFormula> twoBallsFormula() {
    return std::make_unique<BallsFormula>(
        std::vector{Vec3d(-kBallCenter, 0.0, 0.0), Vec3d(kBallCenter, 0.0, 0.0)}, kBallRadius);
}

std::unique_ptr<SolidFormula> hyperboloidFormula() {
    return std::make_unique<HyperboloidFormula>(kHyperboloidWaist, hyperboloidSlope());
}

const std::vector<Shape>& shapes() {
    static const std::vector<Shape> list = {
        {"hyperboloid", makeHyperboloid, hyperboloidFormula},
        {"sphere", makeSphere, sphereFormula},
        {"cube", makeCube, [] { return std::make_unique<CubeFormula>(1.0); }},
        {"torus", makeTorus, [] { return std::make_unique<TorusFormula>(kTorusRing, kTorusTube); }},
        {"two-balls", makeTwoBalls, twoBallsFormula},
        {"tree", makeTree, [] { return std::make_unique<TreeFormula>(tree()); }},
    };
    return list;
}

const Shape& findShape(std::string_view input) {
    if (isShape(input)) {
        for (const Shape& shape : shapes()) {
            if (shape.name == input.substr(kPrefix.size())) return shape;
        }
    }
    std::string known;
    for (const Shape& shape : shapes()) {
        known += (known.empty() ? "" : ", ") + std::string(kPrefix) + shape.name;
    }
    throw Error(ErrorKind::Input,
                "there is no shape \"" + std::string(input) + "\"; expected one of " + known);
}

/// A shape as a formula.
class ShapeField final : public FieldSource {
  public:
    ShapeField(std::string name, const BBoxd& bounds, std::unique_ptr<SolidFormula> formula)
        : mName(std::move(name)), mBounds(bounds), mFormula(std::move(formula)) {}

    std::string name() const override { return mName; }
    BBoxd bounds() const override { return mBounds; }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        SolidRow row(start, step, values);
        mFormula->cross(row);
    }
    std::optional<float> constantIn(const BBoxd& box) const override {
        const std::optional<bool> isInside = mFormula->constantIn(box);
        return isInside ? std::optional(*isInside ? 1.0F : 0.0F) : std::nullopt;
    }

  private:
    std::string mName;
    BBoxd mBounds;
    std::unique_ptr<SolidFormula> mFormula;
};

}  // namespace

const std::vector<std::string>& shapeNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const Shape& shape : shapes()) list.push_back(shape.name);
        return list;
    }();
    return names;
}

bool isShape(std::string_view input) {
    return input.starts_with(kPrefix);
}

std::unique_ptr<BoundarySource> makeShapeBoundary(std::string_view input) {
    return findShape(input).boundary(std::string(input));
}

std::unique_ptr<FieldSource> makeShapeField(std::string_view input) {
    const Shape& shape = findShape(input);
    const std::string name(input);
    return std::make_unique<ShapeField>(name, shape.boundary(name)->bounds(), shape.formula());
}

}  // namespace bandvox
