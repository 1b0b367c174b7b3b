#include "render/blackbody.h"

#include <gtest/gtest.h>

namespace bandvox {
namespace {

using openvdb::Vec3d;

double luminance(const Vec3d& rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// x and y of the CIE's diagram.
openvdb::Vec2d chromaticity(const Vec3d& rgb) {
    const double x = 0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2];
    const double y = luminance(rgb);
    const double z = 0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2];
    return {x / (x + y + z), y / (x + y + z)};
}

TEST(Blackbody, IsOneAt2000Kelvin) {
    EXPECT_NEAR(luminance(blackbodyColor(2000)), 1, 1e-3);
}

TEST(Blackbody, HasThePlanckianLocusColors) {
    // G. Wyszecki, W. Stiles: "Color Science" (1982); within what stands in for the eye.
    const struct {
        double kelvin, x, y;
    } known[] = {{2500, 0.4770, 0.4137},
                 {4000, 0.3805, 0.3768},
                 {6500, 0.3135, 0.3237},
                 {10000, 0.2807, 0.2884}};
    for (const auto& at : known) {
        const auto found = chromaticity(blackbodyColor(at.kelvin));
        EXPECT_NEAR(found[0], at.x, 0.01) << at.kelvin;
        EXPECT_NEAR(found[1], at.y, 0.01) << at.kelvin;
    }
}

TEST(Blackbody, GetsBrighterAsItGetsHotter) {
    double before = 0;
    for (double kelvin = 500; kelvin < 40000; kelvin *= 1.05) {
        const Vec3d color = blackbodyColor(kelvin);
        EXPECT_GT(luminance(color), before) << kelvin;
        before = luminance(color);
        for (int c = 0; c < 3; ++c) EXPECT_GE(color[c], 0);
    }
    EXPECT_EQ(blackbodyColor(60000), blackbodyColor(40000));
}

TEST(Blackbody, IsRedAndThenDark) {
    const Vec3d red = blackbodyColor(1000);
    EXPECT_GT(red[0], 3 * red[1]);
    EXPECT_GT(red[0], 20 * red[2]);
    for (const double kelvin : {499.0, 0.0, -5.0, std::nan("")}) {
        EXPECT_EQ(blackbodyColor(kelvin), Vec3d(0.0));
    }
}

}  // namespace
}  // namespace bandvox
