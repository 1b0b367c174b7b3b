#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/shapes.h>
#include <bandvox/voxelize/field_to_voxels.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace bandvox {
namespace {

using openvdb::BBoxd;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

/// The field exp(-|x|) in a box: 0.5 at |x| = ln 2.
class Peak final : public FieldSource {
  public:
    explicit Peak(const BBoxd& bounds) : mBounds(bounds) {}
    std::string name() const override { return "peak"; }
    BBoxd bounds() const override { return mBounds; }
    void sampleRow(const Vec3d& start, const Vec3d& step, std::span<float> values) const override {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double r = (start + static_cast<double>(i) * step).length();
            values[i] = static_cast<float>(std::exp(-r));
        }
    }

  private:
    BBoxd mBounds;
};

ErrorKind kindOfFailure(const FieldSource& source, const VoxelOptions& options) {
    try {
        fieldToVoxels(source, options);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "voxels came";
    return ErrorKind::Runtime;
}

TEST(FieldToVoxels, AsksEveryShapeAtTheCentresOfVoxels) {
    for (const std::string& name : shapeNames()) {
        SCOPED_TRACE(name);
        const auto field = makeShapeField("shape:" + name);
        const VoxelResult result = fieldToVoxels(*field, {.resolution = 37});
        const double voxelSize = result.grid->voxelSize().x();
        EXPECT_DOUBLE_EQ(voxelSize, 2.0 / 37);
        const auto accessor = result.grid->getConstAccessor();
        std::int64_t count = 0;
        for (auto voxel = CoordBBox(Coord(-21), Coord(21)).begin(); voxel; ++voxel) {
            float value = 0;
            field->sampleRow(voxelSize * (*voxel).asVec3d(), Vec3d(0.0), {&value, 1});
            ASSERT_EQ(accessor.getValue(*voxel), value) << *voxel;
            ASSERT_EQ(accessor.isValueOn(*voxel), value == 1) << *voxel;
            count += value == 1 ? 1 : 0;
        }
        EXPECT_EQ(result.voxels, count);
        EXPECT_EQ(result.grid->metaValue<std::string>("bandvox_source"), "shape:" + name);
        EXPECT_FALSE(densityMetadata(*result.grid));
    }
}

TEST(FieldToVoxels, TakesWhatIsAtLeastHalf) {
    const Peak peak(BBoxd(Vec3d(-2), Vec3d(2)));
    const VoxelResult result = fieldToVoxels(peak, {.voxelSize = 0.05});
    for (auto voxel = CoordBBox(Coord(-40), Coord(40)).begin(); voxel; ++voxel) {
        ASSERT_EQ(result.grid->tree().isValueOn(*voxel),
                  0.05 * (*voxel).asVec3d().length() < std::log(2.0))
            << *voxel;
    }
    // A solid that fills its box ends with it.
    const Peak inner(BBoxd(Vec3d(-0.2), Vec3d(0.2)));
    EXPECT_EQ(fieldToVoxels(inner, {.voxelSize = 0.1}).voxels, 125);
}

TEST(FieldToVoxels, TakesSubSamplesAlongAnyAxis) {
    const auto field = makeShapeField("shape:torus");
    for (const ScanAxis axis : {ScanAxis::X, ScanAxis::Y, ScanAxis::Z}) {
        const VoxelResult result =
            fieldToVoxels(*field, {.voxelSize = 0.0625, .fraction = true, .axis = axis});
        for (auto voxel = CoordBBox(Coord(-17), Coord(17)).begin(); voxel; ++voxel) {
            float sum = 0;
            for (int i = 0; i < 8; ++i) {
                const Vec3d place(i & 1, i >> 1 & 1, i >> 2);
                float value = 0;
                field->sampleRow(0.0625 * ((*voxel).asVec3d() + 0.5 * place - Vec3d(0.25)),
                                 Vec3d(0.0), {&value, 1});
                sum += value;
            }
            ASSERT_EQ(result.grid->tree().getValue(*voxel), sum / 8) << *voxel;
        }
    }
    EXPECT_EQ(kindOfFailure(*field, {.threshold = 9}), ErrorKind::Usage);
}

TEST(FieldToVoxels, IsTheSameForAnyNumberOfThreads) {
    const auto field = makeShapeField("shape:torus");
    const auto make = [&](int threads) {
        const ThreadLimit limit(threads);
        return fieldToVoxels(*field, {.resolution = 60});
    };
    const VoxelResult one = make(1), two = make(2);
    EXPECT_EQ(one.voxels, two.voxels);
    EXPECT_TRUE(one.grid->tree().hasSameTopology(two.grid->tree()));
}

TEST(FieldToVoxels, RefusesWhatCannotBe) {
    const double infinity = std::numeric_limits<double>::infinity();
    const auto sphere = makeShapeField("shape:sphere");
    EXPECT_EQ(kindOfFailure(*sphere, {.resolution = 0}), ErrorKind::Usage);
    EXPECT_EQ(kindOfFailure(*sphere, {.voxelSize = -1}), ErrorKind::Usage);
    EXPECT_EQ(kindOfFailure(*sphere, {.voxelSize = 2e-5}), ErrorKind::Memory);
    EXPECT_EQ(kindOfFailure(*sphere, {.resolution = 1 << 20}), ErrorKind::Input) << "too small";
    EXPECT_EQ(kindOfFailure(*sphere, {.voxelSize = 1e-5}), ErrorKind::Usage);
    EXPECT_EQ(kindOfFailure(Peak(BBoxd()), {}), ErrorKind::Input);
    EXPECT_EQ(kindOfFailure(Peak(BBoxd(Vec3d(1.0), Vec3d(1.0))), {}), ErrorKind::Input);
    EXPECT_EQ(kindOfFailure(Peak(BBoxd(Vec3d(-infinity), Vec3d(infinity))), {}), ErrorKind::Usage);
    EXPECT_EQ(kindOfFailure(Peak(BBoxd(Vec3d(2), Vec3d(3))), {}), ErrorKind::Result);
}

}  // namespace
}  // namespace bandvox
