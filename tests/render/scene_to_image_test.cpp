#include "render/environment.h"
#include "render/scene_pieces.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace bandvox {
namespace {

using namespace render_test;
using openvdb::BBoxd;
using openvdb::Vec3d;

// Everything at once: a coated and a glass ball, a floor, a cloud, lamps with disks, a map.
Scene richScene() {
    Material coated, glassy, matt;
    coated.reflectance = 0.3;
    coated.color = Vec3d(0.7, 0.3, 0.2);
    glassy.transparency = 0.9;
    glassy.roughness = 0.2;
    glassy.tintLength = 30;
    Scene scene;
    scene.objects = {surfaceOf(ballAt({-20, 0, 0}), coated), surfaceOf(ballAt({20, 0, 10}), glassy),
                     surfaceOf(boxGrid(BBoxd(Vec3d(-40, -30, -30), Vec3d(40, -20, 30))), matt)};
    SceneObject cloud;
    cloud.kind = SceneObject::Kind::Volume;
    cloud.grid = ballAt({0, 15, 10});
    cloud.medium.extinction = 0.03;
    cloud.medium.anisotropy = 0.4;
    scene.objects.push_back(cloud);
    Light sun, lamp;
    sun.size = 5;
    lamp.kind = Light::Kind::Point;
    lamp.followsCamera = false;
    lamp.place = Vec3d(0, 60, 20);
    lamp.color = Vec3d(2000);
    lamp.size = 5;
    scene.lights = {sun, lamp};
    PixelArray map{8, 4, 3, {}};
    for (int i = 0; i < 96; ++i) map.values.push_back(0.01F * static_cast<float>(i));
    scene.environment.color = Vec3d(0.5);
    scene.environment.map = std::make_shared<const EnvironmentMap>(map, 30, "map");
    return scene;
}

PictureOptions richPicture() {
    PictureOptions options;
    options.width = 70;
    options.height = 50;
    options.samples = 2;
    options.filter = PixelFilter::Gaussian;
    options.transport.shadows = true;
    options.transport.gather = 1;
    options.transport.bounces = 1;
    options.volumes.method = VolumeOptions::Method::Tracking;
    options.seed = 5;
    return options;
}

void expectSame(const Image& a, const Image& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.position, b.position);
}

TEST(SceneToImage, IsTheSameForAnyNumberOfThreads) {
    const auto draw = [](int threads, VolumeOptions::Method method) {
        const ThreadLimit limit(threads);
        PictureOptions options = richPicture();
        options.volumes.method = method;
        return sceneToImage(richScene(), options);
    };
    for (const auto method : {VolumeOptions::Method::Tracking, VolumeOptions::Method::Steps}) {
        const RenderResult one = draw(1, method), two = draw(2, method);
        expectSame(one.image, two.image);
        EXPECT_EQ(one.hits, two.hits);
        EXPECT_GT(one.hits, 1000);
        for (const float value : one.image.color) ASSERT_TRUE(std::isfinite(value) && value >= 0);
    }
}

TEST(SceneToImage, DrawsAPartAsItIsInTheWhole) {
    const Scene scene = richScene();
    PictureOptions options = richPicture();
    const Image whole = sceneToImage(scene, options).image;
    for (const CropWindow crop : {CropWindow{0, 0, 70, 50}, {13, 7, 59, 44}, {33, 20, 34, 21}}) {
        options.crop = crop;
        const Image part = sceneToImage(scene, options).image;
        ASSERT_EQ(part.width, crop.right - crop.left);
        ASSERT_EQ(part.height, crop.bottom - crop.top);
        EXPECT_EQ(part.left, crop.left);
        EXPECT_EQ(part.fullWidth, 70);
        for (int row = 0; row < part.height; ++row) {
            for (int column = 0; column < part.width; ++column) {
                const std::size_t i = static_cast<std::size_t>(row) * part.width + column;
                const std::size_t j =
                    static_cast<std::size_t>(row + crop.top) * 70 + column + crop.left;
                for (int c = 0; c < 4; ++c)
                    EXPECT_EQ(part.color[4 * i + c], whole.color[4 * j + c]);
                EXPECT_EQ(part.depth[i], whole.depth[j]);
                EXPECT_EQ(normalAt(part, i), normalAt(whole, j));
                EXPECT_EQ(positionAt(part, i), positionAt(whole, j));
            }
        }
    }
}

TEST(SceneToImage, ShowsItselfWithoutChanging) {
    for (const bool rich : {false, true}) {
        Scene scene = richScene();
        if (!rich) {
            scene.objects.resize(1);  // with pixels that are told at once to be empty
            scene.lights.clear();
        }
        PictureOptions options = richPicture();
        options.width = 150;
        options.height = 100;
        options.samples = 1;
        options.camera.lookat = Vec3d(0, 20, 0);
        options.camera.eye = Vec3d(30, 40, 170);
        if (!rich) {
            // In the corner of a coarse pixel, and so small that in the rest of that there are
            // cells that do not see it.
            options.transport = {};
            options.camera.lookat = Vec3d(-20, 0, 0);
            options.camera.eye = Vec3d(-20, 0, 1500);
        }
        options.crop = CropWindow{3, 2, 147, 98};
        const RenderResult expected = sceneToImage(scene, options);
        int calls = 0;
        options.previewSeconds = 0;
        options.preview = [&](const Image& image) {
            ++calls;
            EXPECT_EQ(image.width, 144);
            EXPECT_EQ(image.height, 96);
            EXPECT_EQ(image.color.size(), expected.image.color.size());
        };
        const RenderResult shown = sceneToImage(scene, options);
        expectSame(expected.image, shown.image);
        EXPECT_EQ(expected.hits, shown.hits);
        EXPECT_GT(calls, 2);
    }
}

TEST(SceneToImage, ChangesWithItsSeedOnlyWhatIsRandom) {
    Scene scene = richScene();
    PictureOptions options = richPicture();
    const Image random = sceneToImage(scene, options).image;
    options.seed = 6;
    EXPECT_NE(random.color, sceneToImage(scene, options).image.color);
    options.seed = 5;
    EXPECT_EQ(random.color, sceneToImage(scene, options).image.color);
    for (Light& light : scene.lights) light.size = 0;
    for (SceneObject& object : scene.objects) object.material.roughness = 0;
    options.transport.gather = options.transport.bounces = 0;
    options.transport.depth = 2;  // more of glass is chosen at random
    options.volumes.method = VolumeOptions::Method::Steps;
    const Image even = sceneToImage(scene, options).image;
    options.seed = 6;
    EXPECT_EQ(even.color, sceneToImage(scene, options).image.color);
}

TEST(SceneToImage, ShowsTheNearestOfSeveralObjects) {
    const Vec3d colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double places[] = {-40, 40, 0};
    for (int turn = 0; turn < 3; ++turn) {
        Scene scene;
        for (int i = 0; i < 3; ++i) {
            const int object = (i + turn) % 3;
            Material material;
            material.color = colors[object];
            scene.objects.push_back(surfaceOf(ballAt({0, 0, places[object]}), material));
        }
        scene.environment = furnace();
        const auto seenFrom = [&](double z) {
            return sceneToImage(scene, pictureFrom({0, 0, z}, Vec3d(0.0), 3, 3)).image;
        };
        EXPECT_LT((colorAt(seenFrom(1), 1, 1) - colors[1]).length(), 1e-6);
        EXPECT_LT((colorAt(seenFrom(-1), 1, 1) - colors[0]).length(), 1e-6);
        EXPECT_NEAR(seenFrom(1).depth[4], 60 - ballSurface(kRadius, 0.5), 1e-3);
    }
}

TEST(SceneToImage, LetsGridsBeEmptyIfThatIsAllowed) {
    Scene scene;
    scene.objects = {surfaceOf(openvdb::FloatGrid::create(0), {}),
                     surfaceOf(ballAt(Vec3d(0.0)), {}),
                     surfaceOf(openvdb::FloatGrid::create(0), {})};
    scene.objects[2].kind = SceneObject::Kind::Volume;
    scene.environment = furnace();
    PictureOptions options = pictureFrom({0, 0, 1}, Vec3d(0.0), 5, 50);
    EXPECT_THROW(sceneToImage(scene, options), Error);
    options.allowEmpty = true;
    const Image image = sceneToImage(scene, options).image;
    EXPECT_EQ(image.color[4 * 12 + 3], 1);
    scene.objects.erase(scene.objects.begin() + 1);
    options.background = Vec3d(0.1, 0.2, 0.3);
    const RenderResult empty = sceneToImage(scene, options);
    EXPECT_EQ(empty.hits, 0);
    EXPECT_LT((colorAt(empty.image, 2, 2) - Vec3d(0.1, 0.2, 0.3)).length(), 1e-7);
    // A frame of a sequence without an object has the same environment as the others.
    scene.environment.visible = true;
    scene.environment.color = Vec3d(0.7, 0.6, 0.5);
    const Image around = sceneToImage(scene, options).image;
    EXPECT_LT((colorAt(around, 2, 2) - Vec3d(0.7, 0.6, 0.5)).length(), 1e-7);
    EXPECT_EQ(around.color[3], 1);
}

TEST(SceneToImage, PutsTheBackgroundWhereNothingIsAndTheEnvironmentIfItIsSeen) {
    Scene scene;
    scene.objects = {surfaceOf(ballAt(Vec3d(0.0)), {})};
    scene.environment.color = Vec3d(0.7, 0.6, 0.5);
    PictureOptions options = pictureFrom({0, 0, 1}, Vec3d(0.0), 9, 60);
    EXPECT_EQ(sceneToImage(scene, options).image.color[3], 0);
    options.background = Vec3d(0.2);
    EXPECT_NEAR(sceneToImage(scene, options).image.color[0], 0.2, 1e-7);
    scene.environment.visible = true;
    const Image image = sceneToImage(scene, options).image;
    EXPECT_NEAR(image.color[2], 0.5, 1e-7);
    EXPECT_EQ(image.color[3], 1);
    EXPECT_TRUE(std::isinf(image.depth[0]));
}

struct Refusal {
    ErrorKind kind;
    std::string text;
};

Refusal refusalOf(const Scene& scene, const PictureOptions& options = {}) {
    try {
        sceneToImage(scene, options);
    } catch (const Error& error) {
        return {error.kind(), error.what()};
    }
    ADD_FAILURE() << "nothing was thrown";
    return {ErrorKind::Runtime, ""};
}

void expectRefused(const Scene& scene, ErrorKind kind, const std::string& part,
                   const PictureOptions& options = {}) {
    const Refusal refusal = refusalOf(scene, options);
    EXPECT_EQ(refusal.kind, kind) << part;
    EXPECT_NE(refusal.text.find(part), std::string::npos) << refusal.text << "\n" << part;
}

Scene oneBall() {
    Scene scene;
    scene.objects = {surfaceOf(ballGrid(), {})};
    scene.lights.resize(1);
    return scene;
}

TEST(SceneRefusals, NameWhatIsOutOfRange) {
    const double none = std::nan("");
    const struct {
        std::string part;
        std::function<void(SceneObject&, double)> set;
        std::vector<double> bad;
    } ofObjects[] = {
        {"color", [](SceneObject& o, double v) { o.material.color[1] = v; }, {-0.1, 1e7, none}},
        {"roughness",
         [](SceneObject& o, double v) { o.material.roughness = v; },
         {-0.1, 1.1, none}},
        {"reflectance",
         [](SceneObject& o, double v) { o.material.reflectance = v; },
         {-1, 2, none}},
        {"transparency",
         [](SceneObject& o, double v) { o.material.transparency = v; },
         {-1, 2, none}},
        {"refractive index",
         [](SceneObject& o, double v) { o.material.refractiveIndex = v; },
         {0.9, 5, none}},
        {"length of the tint",
         [](SceneObject& o, double v) { o.material.tintLength = v; },
         {-1, none}},
        {"color of a volume",
         [](SceneObject& o, double v) { o.medium.color[2] = v; },
         {-1, 1.5, none}},
        {"emission", [](SceneObject& o, double v) { o.medium.emission[0] = v; }, {-1, 1e7, none}},
        {"extinction", [](SceneObject& o, double v) { o.medium.extinction = v; }, {-1, none}},
        {"anisotropy", [](SceneObject& o, double v) { o.medium.anisotropy = v; }, {-1, 1, none}},
        {"glow", [](SceneObject& o, double v) { o.medium.glow = v; }, {-1, none}}};
    for (const auto& field : ofObjects) {
        for (const double value : field.bad) {
            Scene scene = oneBall();
            field.set(scene.objects[0], value);
            expectRefused(scene, ErrorKind::Usage, field.part);
        }
    }
    for (const double value : {-1.0, 181.0, none}) {
        Scene scene = oneBall();
        scene.lights[0].size = value;
        expectRefused(scene, ErrorKind::Usage, "size of a light");
        if (value == 181) continue;
        scene.lights[0].kind = Light::Kind::Point;
        expectRefused(scene, ErrorKind::Usage, "radius of a light");
        scene.lights[0].size = 0;
        scene.lights[0].color = Vec3d(value);
        expectRefused(scene, ErrorKind::Usage, "color of a light");
        scene.lights.clear();
        scene.environment.color = Vec3d(value);
        expectRefused(scene, ErrorKind::Usage, "environment");
    }
    Scene scene = oneBall();
    scene.lights[0].place = Vec3d(0.0);
    expectRefused(scene, ErrorKind::Usage, "must be a direction");
    scene.lights[0].kind = Light::Kind::Point;
    scene.lights[0].place = Vec3d(none, 0, 0);
    expectRefused(scene, ErrorKind::Usage, "must be a place");
}

TEST(SceneRefusals, NameOptionsOutOfRange) {
    const struct {
        std::string part;
        std::function<void(PictureOptions&)> set;
    } fields[] = {
        {"width", [](auto& o) { o.width = 0; }},
        {"height", [](auto& o) { o.height = 70000; }},
        {"samples", [](auto& o) { o.samples = 0; }},
        {"tolerance", [](auto& o) { o.tolerance = 1e-7; }},
        {"gather", [](auto& o) { o.transport.gather = -1; }},
        {"distance to gather", [](auto& o) { o.transport.gatherDistance = std::nan(""); }},
        {"bounces", [](auto& o) { o.transport.bounces = 65; }},
        {"directions to gather is 0", [](auto& o) { o.transport.bounces = 1; }},
        {"depth of mirrors", [](auto& o) { o.transport.depth = -1; }},
        {"step in volumes", [](auto& o) { o.volumes.step = 0.01; }},
        {"time between previews", [](auto& o) { o.previewSeconds = -1; }},
        {"background", [](auto& o) { o.background = Vec3d(-1.0); }},
        {"crop window",
         [](auto& o) {
             o.crop = CropWindow{0, 0, 2000, 5};
         }},
        {"crop window", [](auto& o) {
             o.crop = CropWindow{5, 0, 5, 5};
         }}};
    for (const auto& field : fields) {
        PictureOptions options;
        field.set(options);
        expectRefused(oneBall(), ErrorKind::Usage, field.part, options);
    }
}

TEST(SceneRefusals, NameWhatCannotBeDrawn) {
    expectRefused({}, ErrorKind::Usage, "0 objects");
    Scene scene = oneBall();
    scene.objects.resize(65, scene.objects[0]);
    expectRefused(scene, ErrorKind::Usage, "65 objects; expected 1 to 64");
    scene = oneBall();
    scene.objects[0].grid = nullptr;
    expectRefused(scene, ErrorKind::Input, "got none");
    scene = oneBall();
    scene.objects[0].kind = SceneObject::Kind::Volume;
    auto level = openvdb::FloatGrid::create(3);
    level->setName("shell");
    level->setGridClass(openvdb::GRID_LEVEL_SET);
    level->tree().setValue({0, 0, 0}, -1);
    scene.objects[0].grid = level;
    expectRefused(scene, ErrorKind::Input, "\"shell\" is a level set");
    auto foggy = openvdb::FloatGrid::create(0.5);
    foggy->tree().setValue({0, 0, 0}, 1);
    scene.objects[0].grid = foggy;
    expectRefused(scene, ErrorKind::Input, "background of 0.5");
    auto broken = openvdb::FloatGrid::create(0);
    broken->tree().setValue({0, 0, 0}, std::nanf(""));
    scene.objects[0].grid = broken;
    expectRefused(scene, ErrorKind::Input, "not finite");
    scene = oneBall();
    scene.objects[0].iso = 3;
    expectRefused(scene, ErrorKind::Result, "nothing to see");
}

}  // namespace
}  // namespace bandvox
