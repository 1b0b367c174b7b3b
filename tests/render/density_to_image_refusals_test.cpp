#include "render/ball_scene.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/density_to_image.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Pictures that cannot be made, or are stopped.
namespace bandvox {
namespace {

using namespace render_test;
using openvdb::Coord;
using openvdb::Vec3d;

ErrorKind kindOfFailure(openvdb::FloatGrid::ConstPtr grid, const RenderOptions& options,
                        std::string* message = nullptr) {
    try {
        densityToImage(std::move(grid), options);
    } catch (const Error& error) {
        if (message) *message = error.what();
        return error.kind();
    }
    ADD_FAILURE() << "a picture came";
    return ErrorKind::Runtime;
}
TEST(DensityToImage, RefusesWhatIsNoDensity) {
    const RenderOptions options = smallPicture(8, 8);
    EXPECT_EQ(kindOfFailure(openvdb::FloatGrid::create(0), options), ErrorKind::Input);
    EXPECT_EQ(kindOfFailure(nullptr, options), ErrorKind::Input);
    auto bent = ballGrid();
    bent->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(0.0), Vec3d(40.0)), 0.5, 10));
    EXPECT_EQ(kindOfFailure(bent, options), ErrorKind::Input);
    auto grid = ballGrid();
    DensityMetadata metadata = *densityMetadata(*grid);
    metadata.order = -3;
    setDensityMetadata(*grid, metadata);
    EXPECT_EQ(kindOfFailure(grid, options), ErrorKind::Input);
}
TEST(DensityToImage, SaysWhenNothingIsSeen) {
    // Active, but nowhere as dense as the surface.
    auto thin = openvdb::FloatGrid::create(0);
    thin->fill(openvdb::CoordBBox(Coord(0), Coord(20)), 0.2F);
    std::string message;
    EXPECT_EQ(kindOfFailure(thin, smallPicture(8, 8), &message), ErrorKind::Result);
    EXPECT_NE(message.find("0.2"), std::string::npos) << message;
    RenderOptions away = smallPicture(8, 8);
    away.camera.eye = kCenter + Vec3d(0, 0, 60);
    away.camera.lookat = kCenter + Vec3d(0, 0, 90);
    EXPECT_EQ(kindOfFailure(ballGrid(), away), ErrorKind::Result);
}

TEST(DensityToImage, SaysHowFarADensityReaches) {
    // High enough for the surface to lie between the nodes, but it does not.
    const auto small = makeGrid(openvdb::CoordBBox(Coord(-8), Coord(8)), {},
                                [](const Vec3d& x) { return 0.45 * std::exp(-x.lengthSqr() / 8); });
    std::string message;
    EXPECT_EQ(kindOfFailure(small, smallPicture(8, 8), &message), ErrorKind::Result);
    EXPECT_NE(message.find("at most 0.45"), std::string::npos) << message;
}

TEST(DensityToImage, TellsBadGridsFromBadOptions) {
    const auto kindWithIso = [](std::optional<double> given, double stored, float background) {
        auto grid = ballGrid();
        openvdb::tools::changeBackground(grid->tree(), background);
        DensityMetadata metadata = *densityMetadata(*grid);
        metadata.iso = stored;
        setDensityMetadata(*grid, metadata);
        RenderOptions options = smallPicture(8, 8);
        options.iso = given;
        return kindOfFailure(grid, options);
    };
    EXPECT_EQ(kindWithIso({}, std::nan(""), 0), ErrorKind::Input);
    EXPECT_EQ(kindWithIso({}, 0.5, 0.7F), ErrorKind::Input);
    EXPECT_EQ(kindWithIso(0.5, 0.9, 0.7F), ErrorKind::Usage);

    for (const float value : {std::nanf(""), HUGE_VALF}) {
        auto one = ballGrid();
        one->tree().setValue(Coord::round(kCenter), value);
        auto all = openvdb::FloatGrid::create(0);
        all->fill(openvdb::CoordBBox(Coord(0), Coord(20)), value);
        for (const auto& grid : {one, all, openvdb::FloatGrid::create(value)}) {
            grid->tree().setValueOn(Coord(0));
            std::string message;
            EXPECT_EQ(kindOfFailure(grid, smallPicture(8, 8), &message), ErrorKind::Input);
            EXPECT_NE(message.find("not finite"), std::string::npos) << message;
        }
    }
}

TEST(DensityToImage, RefusesOptionsOutOfRange) {
    const auto grid = ballGrid();
    std::vector<RenderOptions> bad(12, smallPicture(8, 8));
    bad[0].width = 0;
    bad[1].height = 65537;
    bad[2].samples = 0;
    bad[3].ambient = 1.5;
    bad[4].ambient = std::nan("");
    bad[5].light = Vec3d(0.0);
    bad[6].color = Vec3d(-1, 0, 0);
    bad[7].background = Vec3d(0, HUGE_VAL, 0);
    bad[8].iso = 0;
    bad[9].iso = std::nan("");
    bad[10].camera.focal = 0;
    bad[11].samples = 1 << 20;
    for (std::size_t i = 0; i < bad.size(); ++i) {
        EXPECT_EQ(kindOfFailure(grid, bad[i]), ErrorKind::Usage) << i;
        // All but iso can be judged before there is a grid.
        if (!bad[i].iso) {
            EXPECT_THROW(requireValid(bad[i]), Error) << i;
        }
    }
}

class Interrupting final : public Progress {
  public:
    bool interrupted() const override { return true; }
};

// Counts how often the work asks whether to stop.
class Asked final : public Progress {
  public:
    bool interrupted() const override {
        ++times;
        return false;
    }
    mutable std::atomic<int> times{0};
};

TEST(DensityToImage, AsksInEveryRowWhetherToStop) {
    Asked progress;
    densityToImage(ballGrid(), smallPicture(16, 90), progress);
    EXPECT_GE(progress.times, 90);
}

TEST(DensityToImage, CanBeInterrupted) {
    Interrupting progress;
    try {
        densityToImage(ballGrid(), smallPicture(), progress);
        ADD_FAILURE() << "it went on";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

}  // namespace
}  // namespace bandvox
