#include <bandvox/bandlimit/field_to_density.h>
#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
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

struct Case {
    const char* shape;
    ExponentialFilter filter;
};

class SampledShape : public testing::TestWithParam<Case> {};

// With twice the samples the error is smaller, and it is never above what is stated.
TEST_P(SampledShape, ApproachesTheExactRoute) {
    const auto [shape, filter] = GetParam();
    const int resolution = 40;
    DensityOptions exactOptions;
    exactOptions.filter = filter;
    exactOptions.resolution = resolution;
    const DensityResult exact = surfaceToDensity(*makeShapeBoundary(shape), exactOptions);
    const auto field = makeShapeField(shape);
    double before = 1;
    for (const int oversample : {2, 4, 8}) {
        const DensityResult result = sampled(*field, filter, resolution, oversample);
        const double error = difference(*exact.grid, *result.grid);
        EXPECT_LT(error, before) << shape << ", P " << oversample;
        EXPECT_LE(error, result.metadata.samplingError + 2e-4) << shape << ", P " << oversample;
        EXPECT_GT(error, 0.02 * result.metadata.samplingError) << "a bound that says nothing";
        EXPECT_EQ(result.metadata.oversampling, oversample);
        EXPECT_EQ(result.metadata.route, "sampled");
        before = error;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, SampledShape,
    testing::Values(Case{"shape:sphere", {2, 0.16}}, Case{"shape:cube", {2, 0.16}},
                    Case{"shape:torus", {4, 0.25}}, Case{"shape:hyperboloid", {2, 0.16}},
                    Case{"shape:two-balls", {8, 0.35}}, Case{"shape:tree", {4, 0.25}}));

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
    options.density.voxelSize = 1e-7;
    EXPECT_EQ(kindOf(options), ErrorKind::Memory);
}

}  // namespace
}  // namespace bandvox
