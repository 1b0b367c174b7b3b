#include <bandvox/core/error.h>
#include <bandvox/render/camera.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using bandvox::Camera;
using bandvox::CameraOptions;
using bandvox::Error;
using bandvox::ErrorKind;
using bandvox::Ray;
using openvdb::BBoxd;
using openvdb::Vec3d;

using Projection = CameraOptions::Projection;
const BBoxd kBox(Vec3d(-1, 2, -3), Vec3d(4, 3.5, 1));

std::vector<Vec3d> corners(const BBoxd& box) {
    std::vector<Vec3d> all;
    for (int i = 0; i < 8; ++i) {
        all.emplace_back(i & 1 ? box.max()[0] : box.min()[0], i & 2 ? box.max()[1] : box.min()[1],
                         i & 4 ? box.max()[2] : box.min()[2]);
    }
    return all;
}

// The place in the picture whose line of sight passes `point`, by inverting `ray` numerically:
// in a linear projection three lines of sight say all.
Vec3d project(const Camera& camera, Projection projection, int width, int height,
              const Vec3d& point) {
    const auto onPlane = [&](double x, double y) {
        const Ray ray = camera.ray(x, y);
        const double along = projection == Projection::Perspective
                                 ? camera.depth(point) / ray.direction.dot(camera.forward())
                                 : camera.depth(point);
        return ray.origin + along * ray.direction;
    };
    const Vec3d origin = onPlane(0, 0);
    const Vec3d right = onPlane(width, 0) - origin, down = onPlane(0, height) - origin;
    const Vec3d offset = point - origin;
    return {width * offset.dot(right) / right.lengthSqr(),
            height * offset.dot(down) / down.lengthSqr(), camera.depth(point)};
}

TEST(Camera, LooksAtTheMiddleAlongItsAxes) {
    CameraOptions options;
    options.eye = Vec3d(0, 0, 10);
    options.lookat = Vec3d(0, 0, 0);
    const Camera camera(options, 200, 100, kBox);
    EXPECT_TRUE(camera.forward().eq(Vec3d(0, 0, -1)));
    EXPECT_TRUE(camera.right().eq(Vec3d(1, 0, 0)));
    EXPECT_TRUE(camera.upward().eq(Vec3d(0, 1, 0)));
    const Ray middle = camera.ray(100, 50);
    EXPECT_TRUE(middle.origin.eq(Vec3d(0, 0, 10)));
    EXPECT_TRUE(middle.direction.eq(Vec3d(0, 0, -1)));
    EXPECT_NEAR(camera.depth(Vec3d(3, -2, 4)), 6, 1e-12);
}

TEST(Camera, HasTheAngleOfItsFilm) {
    CameraOptions options;
    options.eye = Vec3d(0, 0, 10);
    options.lookat = Vec3d(0, 0, 0);
    options.focal = 30;
    options.aperture = 60;  // 45° to each side
    const Camera camera(options, 200, 100, kBox);
    const double diagonal = std::numbers::sqrt2 / 2;
    EXPECT_TRUE(camera.ray(200, 50).direction.eq(Vec3d(diagonal, 0, -diagonal)));
    EXPECT_TRUE(camera.ray(0, 50).direction.eq(Vec3d(-diagonal, 0, -diagonal)));
    // The picture's top is up, and half as far as its side.
    EXPECT_TRUE(camera.ray(100, 0).direction.eq(Vec3d(0, 0.5, -1).unit()));
    for (const double x : {0.0, 13.0, 200.0}) {
        EXPECT_NEAR(camera.ray(x, 77).direction.length(), 1, 1e-12);
    }
}

TEST(Camera, SeesItsFrameWhenOrthographic) {
    CameraOptions options;
    options.projection = Projection::Orthographic;
    options.eye = Vec3d(1, 2, 10);
    options.lookat = Vec3d(1, 2, 0);
    options.frame = 8;
    const Camera camera(options, 400, 200, kBox);
    EXPECT_TRUE(camera.ray(0, 0).origin.eq(Vec3d(-3, 4, 10)));
    EXPECT_TRUE(camera.ray(400, 200).origin.eq(Vec3d(5, 0, 10)));
    EXPECT_TRUE(camera.ray(123, 45).direction.eq(Vec3d(0, 0, -1)));
}

TEST(Camera, FramesTheObject) {
    const std::pair<int, int> sizes[] = {{100, 100}, {300, 100}, {100, 300}, {1, 1}};
    const Vec3d views[] = {{0.55, 0.35, 1}, {1, 0, 0}, {-3, 0.1, 0.2}, {0, 0, -1}, {0.1, 1, 0}};
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        for (const auto& [width, height] : sizes) {
            for (const Vec3d& from : views) {
                CameraOptions options;
                options.projection = projection;
                options.from = from;
                const Camera camera(options, width, height, kBox);
                double tightest = 0;
                for (const Vec3d& corner : corners(kBox)) {
                    const Vec3d place = project(camera, projection, width, height, corner);
                    const double x = std::abs(2 * place[0] / width - 1);
                    const double y = std::abs(2 * place[1] / height - 1);
                    tightest = std::max({tightest, x, y});
                    EXPECT_GT(place[2], 0) << "behind the eye";
                }
                EXPECT_LT(tightest, 1);
                EXPECT_GT(tightest, 0.9) << "too small: " << width << "x" << height << from;
            }
        }
    }
}

TEST(Camera, FramesAroundALookatOfTheUsers) {
    CameraOptions options;
    options.lookat = Vec3d(4, 3.5, 1);
    const Camera camera(options, 100, 100, kBox);
    const Ray middle = camera.ray(50, 50);
    EXPECT_LT((*options.lookat - middle.origin).unit().cross(middle.direction).length(), 1e-9);
    for (const Vec3d& corner : corners(kBox)) {
        const Vec3d place = project(camera, Projection::Perspective, 100, 100, corner);
        EXPECT_GE(std::min(place[0], place[1]), 0);
        EXPECT_LE(std::max(place[0], place[1]), 100);
    }
}

TEST(Camera, SeesFromStraightAboveAndBelow) {
    for (const double side : {1.0, -1.0}) {
        CameraOptions options;
        options.from = Vec3d(0, 3 * side, 0);
        const Camera camera(options, 10, 10, kBox);
        EXPECT_TRUE(camera.forward().eq(Vec3d(0, -side, 0)));
        EXPECT_TRUE(camera.right().eq(Vec3d(1, 0, 0)));
        EXPECT_TRUE(camera.upward().eq(Vec3d(0, 0, -side)));
    }
}

TEST(Camera, JudgesWhatItCanWithoutAnObject) {
    CameraOptions options;
    EXPECT_NO_THROW(requireValid(options));
    options.eye = Vec3d(1, 1, 1);
    EXPECT_NO_THROW(requireValid(options));
    options.lookat = options.eye;
    EXPECT_THROW(requireValid(options), Error);
    options.lookat = Vec3d(1, 5, 1);
    EXPECT_NO_THROW(requireValid(options));
    options.up = Vec3d(0, -1, 0);
    EXPECT_THROW(requireValid(options), Error);
}

TEST(Camera, SaysWhatIsWrongWithAnEye) {
    CameraOptions middle;
    middle.eye = kBox.getCenter();
    CameraOptions huge;
    huge.eye = Vec3d(1e200, 0, 0);
    const auto said = [](const CameraOptions& options) -> std::string {
        try {
            Camera(options, 10, 10, kBox);
        } catch (const Error& error) {
            return error.what();
        }
        return "nothing";
    };
    EXPECT_NE(said(middle).find("middle of the object"), std::string::npos) << said(middle);
    EXPECT_NE(said(huge).find("eye"), std::string::npos) << said(huge);
}

TEST(Camera, RefusesWhatDefinesNoView) {
    std::vector<CameraOptions> bad(10);
    bad[0].eye = bad[0].lookat = Vec3d(1, 1, 1);
    bad[1].from = Vec3d(0, 2, 0);  // along up
    bad[1].up = Vec3d(0, 1, 0);
    bad[2].up = Vec3d(0, 0, 0);
    bad[3].from = Vec3d(0, 0, 0);
    bad[4].focal = 0;
    bad[5].aperture = -1;
    bad[6].frame = -1;
    bad[7].lookat = Vec3d(std::nan(""), 0, 0);
    bad[8].focal = HUGE_VAL;
    bad[9].eye = Vec3d(HUGE_VAL, 0, 0);
    for (std::size_t i = 0; i < bad.size(); ++i) {
        try {
            Camera(bad[i], 10, 10, kBox);
            ADD_FAILURE() << "case " << i << " was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage) << i;
        }
    }
    EXPECT_THROW(Camera({}, 0, 10, kBox), Error);
}

// From anywhere, a ball lies in the middle of the picture and fills it; its box's corners do not
// keep it away.
TEST(Camera, FramesThePointsThatItIsGiven) {
    std::vector<Vec3d> points;
    for (int i = 0; i < 2000; ++i) {
        const double z = 1 - 2 * (i + 0.5) / 2000, angle = 2.399963 * i;
        const double r = std::sqrt(1 - z * z);
        points.push_back(Vec3d(3, -2, 1) + Vec3d(r * std::cos(angle), r * std::sin(angle), z));
    }
    for (const Vec3d& from : {Vec3d(0.55, 0.35, 1), Vec3d(-1, 2, 0.3)}) {
        CameraOptions options;
        options.from = from;
        const Camera camera(options, 100, 100, points);
        const Ray middle = camera.ray(50, 50);
        const Vec3d toCenter = Vec3d(3, -2, 1) - middle.origin;
        EXPECT_LT(toCenter.cross(middle.direction).length(), 0.03);
        // The edges of the picture just miss it.
        for (const auto& [x, y] : {std::pair(0.0, 50.0), {100.0, 50.0}, {50.0, 0.0}}) {
            const Ray edge = camera.ray(x, y);
            const double away = toCenter.cross(edge.direction).length();
            EXPECT_GT(away, 1);
            EXPECT_LT(away, 1.08);
        }
    }
}

// A needle that points at the eye is seen from before its point.
TEST(Camera, StaysAwayFromWhatPointsAtIt) {
    const std::vector<Vec3d> needle{{0, 0, 9}, {0.1, 0, 0}, {-0.1, 0, 0}, {0, 0.1, 0}};
    CameraOptions options;
    options.from = Vec3d(0, 0, 1);
    EXPECT_GE(Camera(options, 100, 100, needle).depth(needle[0]), 0.9 - 1e-12);
    const std::vector<Vec3d> line{{0, 0, 9}, {0, 0, 0}};
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        options.projection = projection;
        const Camera camera(options, 100, 100, line);
        for (const Vec3d& point : line) EXPECT_GT(camera.depth(point), 0.8);
    }
}

}  // namespace
