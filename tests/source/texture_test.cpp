#include <bandvox/source/texture.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace bandvox {
namespace {

using openvdb::Vec2d;

constexpr float kWhole = 65535;

/// A picture of grey texels.
Texture greyTexture(int width, int height, const std::vector<float>& grey) {
    std::vector<std::uint16_t> rgb;
    for (const float value : grey) {
        rgb.insert(rgb.end(), 3, static_cast<std::uint16_t>(std::lround(kWhole * value)));
    }
    return {width, height, std::move(rgb)};
}

float at(const Texture& texture, double u, double v, TextureWrap wrap = TextureWrap::Repeat,
         int level = 0) {
    return texture.sample(Vec2d(u, v), {wrap, wrap}, level)[1];
}

TEST(Texture, BeginsAtTheLowerLeft) {
    // Rows come from the top.
    const Texture texture = greyTexture(2, 2, {0.1F, 0.2F, 0.3F, 0.4F});
    EXPECT_NEAR(at(texture, 0.25, 0.75), 0.1, 1e-5);
    EXPECT_NEAR(at(texture, 0.75, 0.75), 0.2, 1e-5);
    EXPECT_NEAR(at(texture, 0.25, 0.25), 0.3, 1e-5);
    EXPECT_NEAR(at(texture, 0.75, 0.25), 0.4, 1e-5);
    EXPECT_NEAR(at(texture, 0.5, 0.5), 0.25, 1e-5);
    EXPECT_NEAR(at(texture, 0.5, 0.25), 0.35, 1e-5);
}

TEST(Texture, KeepsChannelsApart) {
    const Texture texture(1, 1, {65535, 0, 6554});
    const openvdb::Vec3f color = texture.sample(Vec2d(0.3, 0.9), {}, 0);
    EXPECT_EQ(color[0], 1);
    EXPECT_EQ(color[1], 0);
    EXPECT_NEAR(color[2], 0.1, 1e-5);
}

TEST(Texture, GoesOnBeyondItsEdges) {
    const Texture texture = greyTexture(4, 1, {0.1F, 0.2F, 0.4F, 0.8F});
    const double v = 0.5;
    EXPECT_NEAR(at(texture, 1.125, v), 0.1, 1e-5);
    EXPECT_NEAR(at(texture, -0.125, v), 0.8, 1e-5);
    EXPECT_NEAR(at(texture, 1, v), 0.45, 1e-5) << "between the last and the first";
    EXPECT_NEAR(at(texture, -7.625, v), 0.2, 1e-5);
    EXPECT_NEAR(at(texture, 1.125, v, TextureWrap::Mirror), 0.8, 1e-5);
    EXPECT_NEAR(at(texture, -0.375, v, TextureWrap::Mirror), 0.2, 1e-5);
    EXPECT_NEAR(at(texture, 2.375, v, TextureWrap::Mirror), 0.2, 1e-5);
    EXPECT_NEAR(at(texture, 1, v, TextureWrap::Mirror), 0.8, 1e-5);
    EXPECT_NEAR(at(texture, 1.125, v, TextureWrap::Clamp), 0.8, 1e-5);
    EXPECT_NEAR(at(texture, -5, v, TextureWrap::Clamp), 0.1, 1e-5);
}

TEST(Texture, TakesCoordinatesOfAnySize) {
    const Texture texture = greyTexture(3, 5, std::vector<float>(15, 0.5F));
    for (const double far : {1e9, -1e9, 1e30, -1e30, 3e38}) {
        for (const TextureWrap wrap :
             {TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp}) {
            EXPECT_NEAR(at(texture, far, far, wrap), 0.5, 1e-4) << far;
        }
    }
}

// Of sides that are odd, too.
TEST(Texture, LevelsKeepTheMean) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (const auto& [width, height] : {std::pair(8, 8), {7, 5}, {1, 9}, {13, 2}, {1, 1}}) {
        std::vector<float> grey;
        double mean = 0;
        for (int i = 0; i < width * height; ++i) {
            grey.push_back(uniform(random));
            mean += grey.back() / (width * height);
        }
        const Texture texture = greyTexture(width, height, grey);
        const int last = texture.levels() - 1;
        EXPECT_EQ(last, static_cast<int>(std::floor(std::log2(std::max(width, height)))));
        EXPECT_NEAR(at(texture, 0.2, 0.9, TextureWrap::Repeat, last), mean, 1e-4)
            << width << " " << height;
    }
}

}  // namespace
}  // namespace bandvox
