#include "pictures.h"

#include <bandvox/render/density_to_image.h>
#include <bandvox/spectral/field_to_spectrum.h>
#include <bandvox/spectral/spectrum_to_screen.h>
#include <bandvox/voxelize/field_to_voxels.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace paper_figures {

using bandvox::Image;
using openvdb::Vec3d;

const std::array<Light, 2>& lights() {
    static const std::array<Light, 2> both{
        {{"front", "light in front", {0, 0, 1}},
         {"upper_right", "light at the upper right", {1, 1, 1.2}}}};
    return both;
}

namespace {

constexpr double kNear = -kDomainSide / 2;  // the screen's z, and the least x and y

Image blankImage(int size) {
    const std::size_t pixels = static_cast<std::size_t>(size) * size;
    Image image;
    image.width = image.height = size;
    image.color.assign(4 * pixels, 0.0F);
    image.depth.assign(pixels, std::numeric_limits<float>::infinity());
    image.normal.assign(3 * pixels, 0.0F);
    image.position.assign(3 * pixels, 0.0F);
    image.metadata.emplace_back("Software", std::string("Bandvox"));
    return image;
}

// The place of the screen, x and y from 0 to size - 1, that a pixel looks through.
struct ScreenPlace {
    int x, y;
    ScreenPlace(const Image& image, std::size_t pixel)
        : x(image.width - 1 - static_cast<int>(pixel % image.width)),
          y(image.height - 1 - static_cast<int>(pixel / image.width)) {}
    Vec3d world(int size) const {
        return {kNear + x * kDomainSide / size, kNear + y * kDomainSide / size, kNear};
    }
};

void setSight(Image& image, std::size_t pixel, const Vec3d& position, const Vec3d& normal) {
    image.depth[pixel] = static_cast<float>(position.z() - kNear);
    for (int c = 0; c < 3; ++c) {
        image.position[3 * pixel + c] = static_cast<float>(position[c]);
        image.normal[3 * pixel + c] = static_cast<float>(normal[c]);
    }
}

void setShade(Image& image, std::size_t pixel, double shade) {
    const bool isSeen = !std::isinf(image.depth[pixel]);
    std::fill_n(&image.color[4 * pixel], 3, static_cast<float>(isSeen ? shade : 0));
    image.color[4 * pixel + 3] = isSeen ? 1.0F : 0.0F;
}

bandvox::RenderOptions renderOptions(int size, bandvox::Shading shading, const Light& light) {
    bandvox::RenderOptions options;
    options.width = options.height = size;
    options.shading = shading;
    options.light = light.direction;
    options.color = Vec3d(1);
    options.ambient = 0;
    // Middles of pixels are at places of the screen, and of these size/2 is in the domain's.
    const double aside = -0.5 * kDomainSide / size;
    options.camera.projection = bandvox::CameraOptions::Projection::Orthographic;
    options.camera.eye = Vec3d(aside, aside, kNear);
    options.camera.lookat = Vec3d(aside, aside, 0);
    options.camera.frame = kDomainSide;
    return options;
}

}  // namespace

void relight(Image& image, const Light& light) {
    // The camera's right, up and back are -x, y and -z.
    const Vec3d toLight =
        Vec3d(-light.direction.x(), light.direction.y(), -light.direction.z()).unit();
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        const float* n = &image.normal[3 * pixel];
        setShade(image, pixel, std::max(0.0, toLight.dot(Vec3d(n[0], n[1], n[2]))));
    }
}

void shadeByDepth(Image& image, const openvdb::BBoxd& bounds) {
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        const double z = image.depth[pixel] + kNear;
        setShade(image, pixel, std::clamp((bounds.max().z() - z) / bounds.extents().z(), 0.0, 1.0));
    }
}

TruePicture truePicture(const TrueSurface& surface, int size, const Light& light) {
    TruePicture picture{blankImage(size), {}};
    Image& image = picture.image;
    picture.edgeDistance.assign(image.depth.size(), std::numeric_limits<double>::infinity());
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        const bandvox::Ray ray{ScreenPlace(image, pixel).world(size), Vec3d(0, 0, 1)};
        const auto t = firstHit(surface, ray, kDomainSide);
        if (!t) continue;
        const Vec3d place = ray.origin + *t * ray.direction;
        const NearestPoint found = surface.nearest(place);
        setSight(image, pixel, place, found.normal);
        picture.edgeDistance[pixel] = found.edgeDistance;
    }
    relight(image, light);
    return picture;
}

Image spectralPicture(const bandvox::FieldSource& solid, const SpectralSetting& setting,
                      const Light& light) {
    // Algorithm I.
    bandvox::SpectrumOptions options;
    options.resolution = setting.resolution;
    options.samples = setting.samples;
    options.filter = setting.filter;
    options.domain = {Vec3d(kNear), kDomainSide};
    const bandvox::SpectralVolume volume = bandvox::fieldToSpectrum(solid, options);

    // Algorithm II, with the iso-value of section 4 and the crossings of figure 7.
    const std::vector<float> lattice = volume.lattice();
    bandvox::ScreenOptions screenOptions;
    screenOptions.magnification = setting.size / setting.resolution;
    screenOptions.refine = setting.refine;
    screenOptions.iso = setting.isoPart * *std::max_element(lattice.begin(), lattice.end());
    const bandvox::Screen screen = bandvox::spectrumToScreen(volume, screenOptions);

    Image image = blankImage(setting.size);
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        const ScreenPlace place(image, pixel);
        const std::size_t at = static_cast<std::size_t>(place.y) * screen.size + place.x;
        if (std::isinf(screen.depth[at])) continue;
        setSight(image, pixel,
                 place.world(setting.size) + Vec3d(0, 0, screen.depth[at] * volume.voxelSize()),
                 Vec3d(screen.normal[at]).unit());
    }
    relight(image, light);
    return image;
}

Image voxelPicture(const bandvox::FieldSource& solid, int size, bandvox::Shading shading,
                   const Light& light) {
    const bandvox::VoxelResult voxels =
        bandvox::fieldToVoxels(solid, {.voxelSize = kDomainSide / size});
    return bandvox::densityToImage(voxels.grid, renderOptions(size, shading, light)).image;
}

}  // namespace paper_figures
