#include "render/volume_object.h"

#include "render/blackbody.h"
#include "render/picture_request.h"
#include "render/surface_field.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// How much of light is left through the longest side of the box if nothing is said: e to minus
// this.
constexpr double kChosenDepth = 10;

// What stops less than this of light, through the longest side of the box, is not seen.
constexpr double kNoDepth = 1e-4;

// Kelvin, beyond which a temperature is none.
constexpr float kHottest = 1e9F;

openvdb::Mat4d indexOfWorld(const openvdb::FloatGrid& grid) {
    return grid.transform().baseMap()->getAffineMap()->getMat4().inverse();
}

double longestSide(const openvdb::FloatGrid& grid) {
    const Vec3d size = worldBox(grid).extents();
    return std::max({size[0], size[1], size[2]});
}

// What nobody has band-limited may jump, and interpolated would ring where there is nothing.
std::unique_ptr<Reconstruction> readVolume(const openvdb::FloatGrid::ConstPtr& grid,
                                           const std::optional<DensityMetadata>& metadata,
                                           const PictureOptions& options) {
    if (!metadata) return makeAveragingReconstruction(grid, cacheBytes(options));
    return readLattice(grid, metadata, options);
}

}  // namespace

VolumeObject::VolumeObject(const SceneObject& object, const PictureOptions& options,
                           const Progress& progress)
    : mName(object.name),
      mGrid(object.grid),
      mMedium(object.medium),
      mToIndex(indexOfWorld(*object.grid)),
      mVoxel(shortestVoxelSide(*object.grid)) {
    requireDrawable(*mGrid);
    if (mGrid->getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw Error(ErrorKind::Input,
                    "the grid \"" + mGrid->getName() +
                        "\" is a level set, which holds distances; light goes through densities");
    }
    if (mGrid->background() != 0) {
        throw Error(ErrorKind::Input, "the grid \"" + mGrid->getName() + "\" has a background of " +
                                          std::to_string(mGrid->background()) +
                                          "; expected 0, for a volume that ends");
    }
    const double longest = longestSide(*mGrid);
    mExtinction = mMedium.extinction > 0 ? mMedium.extinction : kChosenDepth / longest;
    const auto metadata = densityMetadata(*mGrid);
    mIsBandLimited = metadata.has_value();
    std::optional<ExponentialFilter> filter;
    if (metadata) filter = ExponentialFilter{metadata->order, metadata->cutoff};
    mBlocks = std::make_unique<VolumeBlocks>(*mGrid, filter, kNoDepth / (mExtinction * longest),
                                             progress);
    if (!mBlocks->finite()) failNotFinite(*mGrid);
    mDensity = readVolume(mGrid, metadata, options);
    if (object.colors) mColors.emplace(object.colors);
    if (!object.temperatures) return;
    requireDrawable(*object.temperatures);
    for (auto kelvin = object.temperatures->cbeginValueOn(); kelvin; ++kelvin) {
        progress.throwIfInterrupted();
        if (!(std::abs(*kelvin) <= kHottest)) failNotFinite(*object.temperatures);
    }
    mToTemperature = indexOfWorld(*object.temperatures);
    mTemperature = readVolume(object.temperatures, densityMetadata(*object.temperatures), options);
}

std::string VolumeObject::whyEmpty() const {
    return (mName.empty() ? "" : mName + ": ") + "no density is above 0";
}

bool VolumeObject::glows() const {
    return mTemperature != nullptr || mMedium.emission.lengthSqr() > 0;
}

VolumeProbe VolumeObject::probe() const {
    return {mDensity->probe(), mTemperature ? mTemperature->probe() : nullptr};
}

double VolumeObject::extinctionAt(const Vec3d& place, VolumeProbe& probe) const {
    return mExtinction * std::max(probe.density->value(mToIndex.transform(place)), 0.0);
}

Vec3d VolumeObject::colorAt(const Vec3d& place) const {
    if (!mColors) return mMedium.color;
    const Vec3d color = mColors->at(place).value_or(mMedium.color);
    return {std::clamp(color[0], 0.0, 1.0), std::clamp(color[1], 0.0, 1.0),
            std::clamp(color[2], 0.0, 1.0)};
}

Vec3d VolumeObject::glowAt(const Vec3d& place, VolumeProbe& probe) const {
    Vec3d glow = mMedium.emission;
    if (probe.temperature) {
        const double kelvin = probe.temperature->value(mToTemperature.transform(place));
        glow += mMedium.glow * blackbodyColor(kelvin);
    }
    return glow;
}

}  // namespace bandvox
