#include "grid/sound_transform.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>

namespace bandvox {
namespace {

using openvdb::Vec3d;
using openvdb::math::Transform;

TEST(SoundTransform, HonestOnesHaveNoFault) {
    EXPECT_EQ(transformFault(*Transform::createLinearTransform(0.01)), "");
    for (const double place : {0.0, -3.5, 1e7, 1e12}) {
        auto moved = Transform::createLinearTransform(1e-4);
        moved->postTranslate(Vec3d(place, -place, 1));
        EXPECT_EQ(transformFault(*moved), "") << place;
    }
    openvdb::Mat4d sheared = openvdb::Mat4d::identity();
    sheared(0, 1) = 0.7;
    sheared(2, 2) = -3;
    sheared(3, 0) = 1e4;
    EXPECT_EQ(transformFault(*Transform::createLinearTransform(sheared)), "");
    auto frustum =
        Transform::createFrustumTransform(openvdb::BBoxd(Vec3d(0), Vec3d(100)), 0.5, 10, 0.1);
    EXPECT_EQ(transformFault(*frustum), "");
    for (const double side : {1e-4, 1e29}) {
        EXPECT_EQ(transformFault(*Transform::createLinearTransform(side)), "") << side;
    }
}

TEST(SoundTransform, SidesThatNoWorldHasAreAFault) {
    for (const double side : {1e31, 1e300}) {
        EXPECT_NE(transformFault(Transform(std::make_shared<openvdb::math::ScaleMap>(Vec3d(side)))),
                  "")
            << side;
    }
    auto far = Transform::createLinearTransform(1.0);
    far->postTranslate(Vec3d(0, 1e31, 0));
    EXPECT_NE(transformFault(*far), "");
}

TEST(SoundTransform, ReadingRefusesWhatAFileSaysWrong) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->setName("density");
    grid->setTransform(Transform::createLinearTransform(0.5));
    std::ostringstream out;
    openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grid});
    const std::string bytes = out.str();
    // Behind its name the map has the sides, twice, their inverses, and more of these: of each
    // axis.
    const std::size_t map = bytes.find("UniformScaleMap") + std::strlen("UniformScaleMap");
    ASSERT_LT(map, bytes.size());
    constexpr int kRows = 3;
    for (int row = 0; row < kRows; ++row) {
        for (const double number : {0.0, 1e-6, 1e-31, 1e308, -1e40, 7.0, std::nan(""),
                                    std::numeric_limits<double>::infinity()}) {
            std::string bad = bytes;
            std::memcpy(bad.data() + map + 24 * row + 8, &number, sizeof number);
            std::istringstream in(bad);
            try {
                readVdb(in, "bad.vdb");
                ADD_FAILURE() << "row " << row << ", number " << number << ": nothing was thrown";
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::Input);
                const std::string message = error.what();
                EXPECT_TRUE(message.starts_with("bad.vdb: grid 'density' has")) << message;
            }
        }
    }
}

}  // namespace
}  // namespace bandvox
