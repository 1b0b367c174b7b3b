// What a camera that nobody has placed frames.

#include "render/picture_request.h"
#include "render/scene_pieces.h"

#include <bandvox/render/turntable.h>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

namespace bandvox::render_test {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;
using Projection = CameraOptions::Projection;

constexpr int kSide = 128;  // of pictures, pixels

// An alpha far below a step of 8 bits.
constexpr float kUnseen = 1e-5F;

// Fog as of other programs: a ball that is whole within `radius` voxels and ends there, and around
// it so many voxels that are active and empty.
openvdb::FloatGrid::Ptr fogBall(int radius, int empty = 0) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto accessor = grid->getAccessor();
    const int reach = radius + empty;
    for (auto at = openvdb::CoordBBox(Coord(-reach), Coord(reach)).begin(); at; ++at) {
        const double distance = (*at).asVec3d().length();
        if (distance <= reach) accessor.setValue(*at, distance <= radius ? 1.0F : 0.0F);
    }
    return grid;
}

Scene fogScene(const openvdb::FloatGrid::ConstPtr& grid) {
    Scene scene;
    SceneObject object;
    object.kind = SceneObject::Kind::Volume;
    object.grid = grid;
    scene.objects.push_back(object);
    return scene;
}

PictureOptions pictureBy(Projection projection, const Vec3d& from) {
    PictureOptions options;
    options.width = options.height = kSide;
    options.camera.projection = projection;
    options.camera.from = from;
    return options;
}

// The highest alpha of the outermost `pixels` pixels of a picture.
float alphaAtBorder(const Image& image, int pixels) {
    float most = 0;
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const int inside =
                std::min({row, column, image.height - 1 - row, image.width - 1 - column});
            const std::size_t pixel = static_cast<std::size_t>(row) * image.width + column;
            if (inside < pixels) most = std::max(most, image.color[4 * pixel + 3]);
        }
    }
    return most;
}

TEST(Framing, HoldsAllOfAForeignFog) {
    for (const int radius : {2, 8, 30}) {
        const Scene scene = fogScene(fogBall(radius));
        for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
            for (const Vec3d& from : {Vec3d(0, 0, 1), Vec3d(0.55, 0.35, 1), Vec3d(1, 1, 0.2)}) {
                const Image image = sceneToImage(scene, pictureBy(projection, from)).image;
                EXPECT_LT(alphaAtBorder(image, 1), kUnseen) << radius << ' ' << from;
                // No farther away than that asks for: a ball fits its box of blocks loosely.
                EXPECT_GT(alphaAtBorder(image, kSide / 4), 0.02) << radius << ' ' << from;
            }
        }
    }
}

TEST(Framing, HoldsAllOfAFogFromAroundAndThroughALongLens) {
    const Scene scene = fogScene(fogBall(6));
    PictureOptions options = pictureBy(Projection::Perspective, {0, 0.3, 1});
    options.camera.focal = 15;  // a wide view
    const std::vector<CameraOptions> cameras = turntable(scene, options, 5);
    const double distance = (*cameras[0].eye - *cameras[0].lookat).length();
    for (const CameraOptions& camera : cameras) {
        EXPECT_NEAR((*camera.eye - *camera.lookat).length(), distance, 1e-9 * distance);
        options.camera = camera;
        EXPECT_LT(alphaAtBorder(sceneToImage(scene, options).image, 1), kUnseen);
    }
}

// A fog that the room around what is active holds is seen from where it always was.
TEST(Framing, LeavesWhatIsNotCut) {
    const auto large = openvdb::FloatGrid::create(0);
    large->fill(openvdb::CoordBBox(Coord(-200, -90, -90), Coord(200, 90, 90)), 1);
    for (const auto& grid : {fogBall(10, 4), large}) {
        const FramedPoints points = pointsToFrame(fogScene(grid));
        ASSERT_FALSE(points.faint.empty());
        for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
            const CameraOptions options = pictureBy(projection, {0.55, 0.35, 1}).camera;
            const Camera active(options, kSide, kSide, points.active);
            const Camera all(options, kSide, kSide, points.active, points.faint);
            EXPECT_EQ(all.eye(), active.eye());
            EXPECT_EQ(all.pixelsPerLength(1), active.pixelsPerLength(1));
        }
    }
    // A density of this library is active as far as it is seen.
    EXPECT_TRUE(pointsToFrame(fogScene(ballGrid())).faint.empty());
}

TEST(Framing, HoldsInactiveValuesThatAreSeen) {
    const auto grid = fogBall(4);
    for (auto voxel = grid->beginValueOn(); voxel; ++voxel) {
        if (voxel.getCoord().x() > 0) voxel.setValueOff();
    }
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        const Image image = sceneToImage(fogScene(grid), pictureBy(projection, {0, 0.2, 1})).image;
        EXPECT_LT(alphaAtBorder(image, 1), kUnseen);
    }
}

}  // namespace
}  // namespace bandvox::render_test
