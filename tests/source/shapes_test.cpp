#include <bandvox/core/error.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec3d;

constexpr double kPi = std::numbers::pi;
constexpr double kHighestFrequency = 0.3;  // cycles per voxel

/// The longest elements on which each rule integrates waves of kHighestFrequency to `tolerance`,
/// found on a straight line, that is, for flat cells.
SurfaceQuadrature quadratureFor(double tolerance) {
    SurfaceQuadrature quadrature;
    for (int rule = 0; rule < kIntervalRules; ++rule) {
        const auto error = [rule](double side) {
            const double phase = 2.0 * kPi * kHighestFrequency * side;
            double sum = 0.0;
            for (const IntervalPoint& p : intervalRule(rule)) {
                sum += p.weight * std::cos(phase * (p.position - 0.5));
            }
            return std::abs(sum - std::sin(0.5 * phase) / (0.5 * phase));
        };
        double side = 1e-3;
        while (error(1.02 * side) < tolerance) side *= 1.02;
        quadrature.cellSide[rule] = side;
    }
    return quadrature;
}

std::vector<SurfaceSample> sampleAll(const BoundarySource& source, const SamplingRegion& region,
                                     const SurfaceQuadrature& quadrature) {
    std::vector<SurfaceSample> samples;
    for (std::size_t i = 0; i < source.elementCount(); ++i) {
        source.sampleElement(i, region, quadrature, samples);
    }
    return samples;
}

/// All of a shape, at this many voxels per world unit; the region is centred about the origin.
std::vector<SurfaceSample> sampleWhole(const BoundarySource& source, double voxelsPerUnit,
                                       const SurfaceQuadrature& quadrature) {
    const double half = 1.5 * voxelsPerUnit;
    return sampleAll(source, {1.0 / voxelsPerUnit, Vec3d(-half), Vec3d(2.0 * half)}, quadrature);
}

std::unique_ptr<BoundarySource> boundary(const std::string& name) {
    return makeShapeBoundary("shape:" + name);
}

float valueAt(const FieldSource& field, const Vec3d& point) {
    float value = -1.0f;
    field.sampleRow(point, Vec3d(0.0), {&value, 1});
    return value;
}

TEST(Shapes, FitTheBoxWithTheirLongestSide) {
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        const auto box = source->bounds();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(box.min()[axis], -1.0) << name;
            EXPECT_LE(box.max()[axis], 1.0) << name;
        }
        EXPECT_NEAR(box.extents()[box.maxExtent()], 2.0, 1e-12) << name;
        EXPECT_EQ(source->name(), "shape:" + name);
        const auto field = makeShapeField("shape:" + name);
        EXPECT_EQ(field->name(), source->name());
        EXPECT_EQ(field->bounds(), box) << name;
    }
}

TEST(Shapes, RefuseUnknownNames) {
    EXPECT_TRUE(isShape("shape:teapot"));
    EXPECT_FALSE(isShape("torus"));
    EXPECT_FALSE(isShape(""));
    for (const char* input : {"shape:teapot", "shape:", "torus", "", "shape:Torus"}) {
        try {
            makeShapeBoundary(input);
            FAIL() << input;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Input);
            EXPECT_NE(std::string(error.what()).find("shape:two-balls"), std::string::npos);
        }
        EXPECT_THROW(makeShapeField(input), Error) << input;
    }
}

TEST(Shapes, SatisfyTheDivergenceTheorem) {
    const SurfaceQuadrature quadrature = quadratureFor(1e-6);
    const double scale = 16.0;
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        Vec3d sum(0.0);
        double volume = 0.0;
        double area = 0.0;
        for (const SurfaceSample& s : sampleWhole(*source, scale, quadrature)) {
            const Vec3d areaVector(s.areaVector);
            sum += areaVector;
            volume += (Vec3d(s.position) - Vec3d(1.5 * scale)).dot(areaVector) / 3.0;
            area += areaVector.length();
        }
        const double areaScale = scale * scale;
        EXPECT_LT(sum.length() / areaScale, 1e-5) << name;
        EXPECT_NEAR(volume / (areaScale * scale) / source->volume(), 1.0, 2e-6) << name;
        EXPECT_NEAR(area / areaScale / source->area(), 1.0, 2e-6) << name;
    }
}

TEST(Shapes, FormulaEnclosesTheVolume) {
    // One random point in each cell of a lattice: only cells at the surface can err.
    constexpr int kSide = 128;
    const double step = 2.0 / kSide;
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        const auto field = makeShapeField("shape:" + name);
        std::mt19937 random(5);
        std::uniform_real_distribution<double> jitter(0.0, 1.0);
        double inside = 0.0;
        for (int i = 0; i < kSide * kSide * kSide; ++i) {
            const Vec3d cell(i % kSide, i / kSide % kSide, i / (kSide * kSide));
            const Vec3d shift(jitter(random), jitter(random), jitter(random));
            inside += valueAt(*field, Vec3d(-1.0) + step * (cell + shift));
        }
        const double deviation = 0.5 * std::sqrt(1.5 * source->area()) * step * step;
        EXPECT_NEAR(inside * step * step * step, source->volume(), 4.0 * deviation) << name;
    }
}

TEST(Shapes, RowsAreTheSameAsPoints) {
    for (const std::string& name : shapeNames()) {
        const auto field = makeShapeField("shape:" + name);
        long inside = 0;
        for (int i = 0; i < 40; ++i) {
            const Vec3d start(-1.02, -0.98 + 0.05 * i, -0.3);
            const Vec3d step(0.011, 0.001, 0.003);
            std::vector<float> row(200, -1.0f);
            field->sampleRow(start, step, row);
            inside += std::count(row.begin(), row.end(), 1.0f);
            for (std::size_t x = 0; x < row.size(); ++x) {
                EXPECT_EQ(row[x], valueAt(*field, start + double(x) * step)) << name << x;
            }
        }
        EXPECT_GT(inside, 0) << name;
        field->sampleRow(Vec3d(0.0), Vec3d(1.0), {});
    }
}

TEST(Shapes, WindingNumberOfTheSamplesIsTheFormula) {
    const SurfaceQuadrature quadrature = quadratureFor(1e-4);
    for (const std::string& name : shapeNames()) {
        const double scale = name == "tree" ? 400.0 : 60.0;
        const auto source = boundary(name);
        const auto field = makeShapeField("shape:" + name);
        const std::vector<SurfaceSample> samples = sampleWhole(*source, scale, quadrature);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> coordinate(-1.05, 1.05);
        int tested = 0;
        int inside = 0;
        for (int attempt = 0; attempt < 200000 && tested < 60; ++attempt) {
            const Vec3d point(coordinate(random), coordinate(random), coordinate(random));
            // Half of the points are to lie inside, however thin the shape.
            if (valueAt(*field, point) != static_cast<float>(tested % 2)) continue;
            const Vec3d origin = (point + Vec3d(1.5)) * scale;
            double winding = 0.0;
            double nearest = 1e30;
            for (const SurfaceSample& s : samples) {
                const Vec3d ray = Vec3d(s.position) - origin;
                const double distance = ray.length();
                nearest = std::min(nearest, distance);
                winding += ray.dot(Vec3d(s.areaVector)) / (distance * distance * distance);
            }
            if (nearest < 2.0) continue;
            EXPECT_NEAR(winding / (4.0 * kPi), valueAt(*field, point), 0.03) << name << point;
            inside += valueAt(*field, point) > 0.5f;
            ++tested;
        }
        EXPECT_EQ(tested, 60) << name;
        EXPECT_EQ(inside, 30) << name;
    }
}

/// ∮ n e^{-2πi k·x} dA / area.
std::array<std::complex<double>, 3> transform(const std::vector<SurfaceSample>& samples,
                                              const Vec3d& center, const Vec3d& k, double area) {
    std::array<std::complex<double>, 3> sum{};
    for (const SurfaceSample& s : samples) {
        const std::complex<double> wave =
            std::polar(1.0 / area, -2.0 * kPi * k.dot(Vec3d(s.position) - center));
        for (int axis = 0; axis < 3; ++axis) sum[axis] += wave * double(s.areaVector[axis]);
    }
    return sum;
}

Vec3d randomFrequency(std::mt19937& random) {
    std::normal_distribution<double> normal;
    Vec3d k(normal(random), normal(random), normal(random));
    k.normalize();
    return k * std::uniform_real_distribution<double>(0.0, kHighestFrequency)(random);
}

TEST(Shapes, SphereHasItsClosedTransformAtAnySize) {
    const auto source = boundary("sphere");
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
        const SurfaceQuadrature quadrature = quadratureFor(tolerance);
        for (const double radius : {0.5, 1.0, 2.0, 4.0, 10.0, 30.0}) {
            const auto samples = sampleWhole(*source, radius, quadrature);
            const double area = 4.0 * kPi * radius * radius;
            std::mt19937 random(7);
            for (int trial = 0; trial < 20; ++trial) {
                const Vec3d k = randomFrequency(random);
                const double q = 2.0 * kPi * k.length() * radius;
                // The gradient of the ball's own transform.
                const double ball = 4.0 * kPi * std::pow(radius, 3.0) *
                                    (std::sin(q) - q * std::cos(q)) / (q * q * q);
                const auto sum = transform(samples, Vec3d(1.5 * radius), k, area);
                for (int axis = 0; axis < 3; ++axis) {
                    const std::complex<double> exact(0.0, 2.0 * kPi * k[axis] * ball / area);
                    EXPECT_LT(std::abs(sum[axis] + exact), tolerance)
                        << "radius " << radius << " tolerance " << tolerance;
                }
            }
        }
    }
}

TEST(Shapes, CurvedCellsAreAsAccurateAsFlatOnes) {
    const SurfaceQuadrature fine = quadratureFor(1e-9);
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        for (const double scale : {1.0, 3.0, 8.0}) {
            const double area = source->area() * scale * scale;
            const auto exact = sampleWhole(*source, scale, fine);
            for (const double tolerance : {1e-3, 1e-5}) {
                const auto samples = sampleWhole(*source, scale, quadratureFor(tolerance));
                std::mt19937 random(7);
                for (int trial = 0; trial < 5; ++trial) {
                    const Vec3d k = randomFrequency(random);
                    const auto a = transform(samples, Vec3d(1.5 * scale), k, area);
                    const auto b = transform(exact, Vec3d(1.5 * scale), k, area);
                    for (int axis = 0; axis < 3; ++axis) {
                        EXPECT_LT(std::abs(a[axis] - b[axis]), tolerance)
                            << name << " scale " << scale << " tolerance " << tolerance;
                    }
                }
            }
        }
    }
}

TEST(Shapes, EverySampleBelongsToExactlyOneOfNeighbouringRegions) {
    const SurfaceQuadrature quadrature = quadratureFor(1e-3);
    const double scale = 16.0;
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        // Faces of the cube lie on faces of the regions.
        const auto whole = sampleAll(*source, {1.0 / scale, Vec3d(-32), Vec3d(64)}, quadrature);
        std::size_t count = 0;
        Vec3d moment(0.0);
        for (int i = 0; i < 512; ++i) {
            const Vec3d origin = 8.0 * Vec3d(i / 64 - 4, i / 8 % 8 - 4, i % 8 - 4);
            const auto part = sampleAll(*source, {1.0 / scale, origin, Vec3d(8)}, quadrature);
            count += part.size();
            for (const SurfaceSample& s : part) {
                moment += (Vec3d(s.position) + origin) * double(s.areaVector.length());
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GE(s.position[axis], 0.0f) << name;
                    ASSERT_LE(s.position[axis], 8.0f) << name;
                }
            }
        }
        Vec3d expected(0.0);
        for (const SurfaceSample& s : whole) {
            expected += (Vec3d(s.position) - Vec3d(32)) * double(s.areaVector.length());
        }
        EXPECT_EQ(count, whole.size()) << name;
        EXPECT_LT((moment - expected).length(), 1e-2) << name;
    }
}

TEST(Shapes, SamplesLieInTheBoundsOfTheirElement) {
    const SurfaceQuadrature quadrature = quadratureFor(1e-3);
    const double scale = 20.0;
    for (const std::string& name : shapeNames()) {
        const auto source = boundary(name);
        for (std::size_t i = 0; i < source->elementCount(); ++i) {
            std::vector<SurfaceSample> samples;
            source->sampleElement(i, {1.0 / scale, Vec3d(-32), Vec3d(64)}, quadrature, samples);
            EXPECT_FALSE(samples.empty()) << name << i;
            const auto box = source->elementBounds(i);
            for (const SurfaceSample& s : samples) {
                const Vec3d p = (Vec3d(s.position) - Vec3d(32)) / scale;
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GE(p[axis], box.min()[axis] - 1e-6) << name << i;
                    ASSERT_LE(p[axis], box.max()[axis] + 1e-6) << name << i;
                }
            }
        }
    }
}

TEST(Shapes, TwoBallsAreApart) {
    const auto field = makeShapeField("shape:two-balls");
    EXPECT_EQ(valueAt(*field, Vec3d(0.0)), 0.0f);
    EXPECT_EQ(valueAt(*field, Vec3d(0.029, 0, 0)), 0.0f);
    EXPECT_EQ(valueAt(*field, Vec3d(0.031, 0, 0)), 1.0f);
    EXPECT_EQ(valueAt(*field, Vec3d(-0.031, 0, 0)), 1.0f);
}

TEST(Shapes, RefuseAQuadratureWithoutLengths) {
    std::vector<SurfaceSample> samples;
    EXPECT_THROW(boundary("cube")->sampleElement(0, {1.0, Vec3d(-1), Vec3d(4)}, {}, samples),
                 Error);
}

}  // namespace
}  // namespace bandvox
