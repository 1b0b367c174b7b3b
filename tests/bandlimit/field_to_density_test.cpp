#include "bandlimit/closed_form_density.h"

#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>

namespace bandvox {
namespace {

using openvdb::Vec3d;

DensityResult sampled(const FieldSource& source, const ExponentialFilter& filter, int resolution,
                      int oversample, int tile = 0) {
    FieldDensityOptions options;
    options.density.filter = filter;
    options.density.resolution = resolution;
    options.density.tile = tile;
    options.oversample = oversample;
    return fieldToDensity(source, options);
}

// The largest difference between two grids, over all voxels of both.
double difference(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b) {
    openvdb::CoordBBox box = a.evalActiveVoxelBoundingBox();
    box.expand(b.evalActiveVoxelBoundingBox());
    const auto inA = a.getConstAccessor();
    const auto inB = b.getConstAccessor();
    double largest = 0;
    for (auto voxel = box.begin(); voxel; ++voxel) {
        largest = std::max<double>(largest, std::abs(inA.getValue(*voxel) - inB.getValue(*voxel)));
    }
    return largest;
}

// A Gaussian exp(-|p - c|²/(2s²)) and its own filtered version, which is a wider Gaussian.
class GaussianBlob final : public FieldSource {
  public:
    GaussianBlob(const Vec3d& center, double width) : mCenter(center), mWidth(width) {}
    std::string name() const override { return "blob"; }
    openvdb::BBoxd bounds() const override {
        return {mCenter - Vec3d(7 * mWidth), mCenter + Vec3d(7 * mWidth)};
    }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = static_cast<float>(filtered(start + double(i) * step, 0));
        }
    }
    // After a Gaussian filter whose kernel has the standard deviation `sigma`, world units.
    double filtered(const Vec3d& at, double sigma) const {
        const double variance = mWidth * mWidth + sigma * sigma;
        return std::pow(mWidth * mWidth / variance, 1.5) *
               std::exp(-(at - mCenter).lengthSqr() / (2 * variance));
    }

  private:
    Vec3d mCenter;
    double mWidth;
};

// A turned box: none of its faces lies along the samples.
class BoxField final : public FieldSource {
  public:
    BoxField(const TurnedBox& box, double voxelSize) : mBox(box), mVoxelSize(voxelSize) {}
    std::string name() const override { return "box"; }
    openvdb::BBoxd bounds() const override {
        return MeshSource("box", mBox.mesh(mVoxelSize)).bounds();
    }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        const openvdb::Mat3R back = mBox.rotation.transpose();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Vec3d at = (start + double(i) * step) / mVoxelSize - mBox.center;
            const Vec3d p = back * at;
            const bool isInside = std::abs(p.x()) <= mBox.half.x() &&
                                  std::abs(p.y()) <= mBox.half.y() &&
                                  std::abs(p.z()) <= mBox.half.z();
            values[i] = isInside ? 1.0F : 0.0F;
        }
    }

  private:
    TurnedBox mBox;  // voxels
    double mVoxelSize;
};

// One value in a box.
class ConstantField final : public FieldSource {
  public:
    ConstantField(const openvdb::BBoxd& box, float value) : mBox(box), mValue(value) {}
    std::string name() const override { return "constant"; }
    openvdb::BBoxd bounds() const override { return mBox; }
    void sampleRow(const Vec3d&, const Vec3d&, std::span<float> values) const override {
        std::fill(values.begin(), values.end(), mValue);
    }

  private:
    openvdb::BBoxd mBox;
    float mValue;
};

const ExponentialFilter kFilters[] = {{2, 0.16}, {4, 0.25}, {8, 0.35}};

class SampledShape : public testing::TestWithParam<std::string> {};

// With twice the samples the error is smaller, and it is never above what is stated.
TEST_P(SampledShape, ApproachesTheExactRoute) {
    const std::string shape = "shape:" + GetParam();
    const auto field = makeShapeField(shape);
    for (const ExponentialFilter& filter : kFilters) {
        DensityOptions exactOptions;
        exactOptions.filter = filter;
        exactOptions.resolution = 40;
        const DensityResult exact = surfaceToDensity(*makeShapeBoundary(shape), exactOptions);
        double before = 1;
        for (const int oversample : {1, 2, 4, 8}) {
            const DensityResult result =
                sampled(*field, filter, exactOptions.resolution, oversample);
            const double error = difference(*exact.grid, *result.grid);
            EXPECT_LT(error, before) << filter.order << ", P " << oversample;
            EXPECT_EQ(result.metadata.oversampling, oversample);
            EXPECT_EQ(result.metadata.route, "sampled");
            before = error;
            if (oversample == 1) continue;
            EXPECT_LE(error, result.metadata.samplingError) << filter.order << ", P " << oversample;
            EXPECT_GT(error, 0.1 * result.metadata.samplingError) << "a bound that says nothing";
        }
    }
}

// At an odd number of voxels faces lie half way between the samples for P = 1, which is luck; from
// P = 2 on each doubling is better there, too.
TEST_P(SampledShape, ApproachesTheExactRouteAtAnOddNumberOfVoxels) {
    const std::string shape = "shape:" + GetParam();
    const auto field = makeShapeField(shape);
    DensityOptions exactOptions;
    exactOptions.filter = kFilters[0];
    exactOptions.resolution = 33;
    const DensityResult exact = surfaceToDensity(*makeShapeBoundary(shape), exactOptions);
    double before = 1;
    for (const int oversample : {2, 4, 8, 16}) {
        const DensityResult result =
            sampled(*field, exactOptions.filter, exactOptions.resolution, oversample);
        const double error = difference(*exact.grid, *result.grid);
        EXPECT_LT(error, before) << "P " << oversample;
        EXPECT_LE(error, result.metadata.samplingError) << "P " << oversample;
        before = error;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, SampledShape,
                         testing::Values("sphere", "cube", "torus", "hyperboloid", "two-balls",
                                         "tree"),
                         [](const auto& test) {
                             std::string name = test.param;
                             std::erase(name, '-');
                             return name;
                         });

TEST(FieldToDensity, TurnedBoxApproachesItsTransform) {
    const TurnedBox box{Vec3d(14.1, 9.7, 7.9), Vec3d(0.31, -0.17, 0.43), someRotation()};
    const BoxField field(box, 1);
    for (const ExponentialFilter& filter : kFilters) {
        const ClosedFormDensity truth(96, filter, box.transform());
        double before = 1;
        for (const int oversample : {1, 2, 4, 8}) {
            FieldDensityOptions options;
            options.density.filter = filter;
            options.density.voxelSize = 1;
            options.oversample = oversample;
            const DensityResult result = fieldToDensity(field, options);
            const double error = truth.largestError(*result.grid);
            EXPECT_LT(error, before) << filter.order << ", P " << oversample;
            if (oversample > 1) {
                EXPECT_LE(error, result.metadata.samplingError)
                    << filter.order << ", P " << oversample;
            }
            before = error;
        }
    }
}

// The hardest to measure: faces along the samples, and near to each other, anywhere between them.
TEST(FieldToDensity, PlatesOfTwoVoxelsKeepToTheStatedError) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 40; ++i) {
        TurnedBox box{Vec3d(4 + 4 * unit(random), 4 + 4 * unit(random), 4 + 4 * unit(random)),
                      Vec3d(unit(random), unit(random), unit(random)), openvdb::Mat3R::identity()};
        box.half[i % 3] = 1 + unit(random);
        FieldDensityOptions options;
        options.density.voxelSize = 1;
        options.oversample = i % 2 == 0 ? 2 : 4;
        const DensityResult result = fieldToDensity(BoxField(box, 1), options);
        const ClosedFormDensity truth(48, options.density.filter, box.transform());
        EXPECT_LE(truth.largestError(*result.grid), result.metadata.samplingError) << box.half;
    }
}

// Voxels of 2^-3 and centres on multiples of 2^-10, so that the shift itself is exact.
TEST(FieldToDensity, WholeVoxelShiftShiftsEveryBit) {
    constexpr double kVoxel = 0.125;
    FieldDensityOptions options;
    options.density.voxelSize = kVoxel;
    options.oversample = 4;
    const TurnedBox box{Vec3d(14.5, 9.75, 7.25), Vec3d(0.5, -0.25, 0.75),
                        openvdb::Mat3R::identity()};
    const DensityResult reference = fieldToDensity(BoxField(box, kVoxel), options);
    for (const openvdb::Coord shift : {openvdb::Coord(1, 0, 0), openvdb::Coord(-8, 129, -1001)}) {
        TurnedBox moved = box;
        moved.center += shift.asVec3d();
        const DensityResult result = fieldToDensity(BoxField(moved, kVoxel), options);
        EXPECT_EQ(result.grid->activeVoxelCount(), reference.grid->activeVoxelCount());
        for (auto value = reference.grid->cbeginValueOn(); value; ++value) {
            if (!value.isVoxelValue()) continue;
            ASSERT_EQ(result.grid->tree().getValue(value.getCoord() + shift), *value);
        }
    }
}

TEST(FieldToDensity, ConstantFieldIsABoxOfItsValue) {
    // Samples on the faces count, so the box comes out larger by half a sample on each side.
    const double half = 80 + 0.25;
    const ConstantField field({Vec3d(-80), Vec3d(80)}, 0.7F);
    FieldDensityOptions options;
    options.density.voxelSize = 1;
    options.oversample = 2;
    const DensityResult result = fieldToDensity(field, options);
    // A tile in which all samples are one value is not transformed.
    EXPECT_EQ(result.grid->tree().getValue(openvdb::Coord(0)), 0.7F);
    EXPECT_LT(result.tiles, 64);
    EXPECT_NEAR(result.metadata.gridVolume / (0.7 * std::pow(2 * half, 3)), 1, 1e-4);
    EXPECT_NEAR(result.maximum, 0.7, 1e-5);
    EXPECT_EQ(result.metadata.sourceVolume, 0);

    // All of the error is that of where the faces come to lie.
    const double slope = options.density.filter.cutoff * std::sqrt(std::numbers::pi);
    EXPECT_GE(result.metadata.samplingError, 0.7 * slope * 0.25);
}

TEST(FieldToDensity, EmptyFieldIsAnError) {
    const Vec3d corner(1, 2, 3);
    for (const ConstantField& field :
         {ConstantField({corner, corner + Vec3d(10)}, 0), ConstantField({corner, corner}, 1),
          ConstantField(openvdb::BBoxd(), 1)}) {
        try {
            sampled(field, {2, 0.16}, 20, 2);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Result) << error.what();
        }
    }
}

TEST(FieldToDensity, StopsWhenInterrupted) {
    class Impatient : public Progress {
      public:
        bool interrupted() const override { return true; }
    } impatient;
    try {
        fieldToDensity(*makeShapeField("shape:sphere"), {}, impatient);
        FAIL() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

// Warned of with both numbers, or not at all.
TEST(FieldToDensity, SamplingErrorAboveItsToleranceIsAWarning) {
    FieldDensityOptions options;
    options.density.resolution = 24;
    const auto field = makeShapeField("shape:cube");
    EXPECT_TRUE(fieldToDensity(*field, options).warnings.empty());
    options.samplingTolerance = 0.0123;
    const DensityResult result = fieldToDensity(*field, options);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_NE(result.warnings[0].find("0.0123"), std::string::npos) << result.warnings[0];
    EXPECT_EQ(result.metadata.tolerance, options.density.tolerance);
    EXPECT_EQ(densityMetadata(*result.grid)->samplingError, result.metadata.samplingError);
}

TEST(FieldToDensity, SmoothFieldIsItsOwnFilteredVersion) {
    const ExponentialFilter filter{2, 0.16};
    const GaussianBlob blob(Vec3d(0.3, -0.2, 5.1), 1);
    const DensityResult result = sampled(blob, filter, 60, 2);
    const double voxel = result.grid->voxelSize().x();
    const double sigma = voxel / (std::sqrt(2.0) * std::numbers::pi * filter.cutoff);
    double largest = 0;
    for (auto value = result.grid->cbeginValueOn(); value; ++value) {
        const Vec3d at = voxel * value.getCoord().asVec3d();
        largest = std::max(largest, std::abs(*value - blob.filtered(at, sigma)));
    }
    EXPECT_LE(largest, 1e-4);
    EXPECT_NEAR(result.metadata.gridVolume, std::pow(2 * std::numbers::pi, 1.5), 2e-2);
    EXPECT_LE(result.metadata.samplingError, 1e-5);
}

TEST(FieldToDensity, TilesOfAnySideAgree) {
    const auto field = makeShapeField("shape:hyperboloid");
    const DensityResult truth = sampled(*field, {2, 0.16}, 50, 4, 96);
    for (const int tile : {32, 64}) {
        const DensityResult result = sampled(*field, {2, 0.16}, 50, 4, tile);
        EXPECT_LE(difference(*truth.grid, *result.grid), 1e-4) << tile;
    }
}

TEST(FieldToDensity, ThreadsChangeNothing) {
    const auto field = makeShapeField("shape:torus");
    std::vector<openvdb::FloatGrid::Ptr> grids;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        grids.push_back(sampled(*field, {4, 0.25}, 60, 4).grid);
    }
    EXPECT_EQ(difference(*grids[0], *grids[1]), 0);
    EXPECT_EQ(grids[0]->activeVoxelCount(), grids[1]->activeVoxelCount());
}

// What a formula says of a box is true at every place in it.
TEST(FieldToDensity, ShapesNeverLieAboutBoxes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1.2, 1.2), size(0, 0.3), inside(0, 1);
    for (const std::string& name : shapeNames()) {
        const auto field = makeShapeField("shape:" + name);
        int told = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3d low(place(random), place(random), place(random));
            const Vec3d extents(size(random), size(random), size(random));
            const auto value = field->constantIn({low, low + extents});
            if (!value) continue;
            ++told;
            for (int j = 0; j < 20; ++j) {
                const Vec3d at =
                    low + extents * Vec3d(inside(random), inside(random), inside(random));
                float found = -1;
                field->sampleRow(at, Vec3d(0, 0, 0.01), {&found, 1});
                ASSERT_EQ(found, *value) << name << " at " << at;
            }
        }
        EXPECT_GT(told, 300) << name;
    }
}

TEST(FieldToDensity, OddOversamplingHasNoKnownError) {
    const DensityResult result = sampled(*makeShapeField("shape:sphere"), {2, 0.16}, 20, 3);
    EXPECT_TRUE(std::isnan(result.metadata.samplingError));
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_NE(result.warnings.front().find("not known"), std::string::npos);
}

TEST(FieldToDensity, RefusesWhatCannotBe) {
    const auto field = makeShapeField("shape:sphere");
    const auto kindOf = [&](const FieldDensityOptions& options) {
        try {
            fieldToDensity(*field, options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Runtime;
    };
    FieldDensityOptions options;
    options.oversample = 0;
    EXPECT_EQ(kindOf(options), ErrorKind::Usage);
    options.oversample = 65;
    EXPECT_EQ(kindOf(options), ErrorKind::Usage);
    options.oversample = 4;
    options.density.voxelSize = 2e-5;
    EXPECT_EQ(kindOf(options), ErrorKind::Memory);
}

}  // namespace
}  // namespace bandvox
