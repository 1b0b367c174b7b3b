#include "render/surface_object.h"

#include "render/picture_request.h"

#include <algorithm>
#include <sstream>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// Gradients below this part of a flat face's have no direction worth showing.
constexpr double kFlatGradient = 1e-4;

}  // namespace

SurfaceObject::SurfaceObject(const SceneObject& object, const PictureOptions& options,
                             const Progress& progress)
    : mName(object.name),
      mMaterial(object.material),
      mFacets(object.material.roughness),
      mCoat(mFacets, object.material.reflectance),
      mDrawable(makeDrawable(object.grid, object.iso)),
      mToIndex(mDrawable.grid->transform().baseMap()->getAffineMap()->getMat4().inverse()),
      mVoxel(shortestVoxelSide(*mDrawable.grid)) {
    worldBox(grid());  // refuses what is not finite
    mBlocks = std::make_unique<SurfaceBlocks>(grid(), surfaceThreshold(mDrawable), progress);
    if (!mBlocks->finite()) failNotFinite(grid());
    if (object.colors) mColors.emplace(object.colors);
    if (empty()) return;
    mField = readSurface(mDrawable, mBlocks->maximum(), options, progress);
    mMarch.emplace(*mBlocks, mDrawable.iso, mField->clear, mDrawable.grid.get(), mField->inside);
    mFlat = kFlatGradient * mField->slope;
}

std::string SurfaceObject::whyEmpty() const {
    std::ostringstream message;
    if (!mName.empty()) message << mName << ": ";
    if (mDrawable.isLevelSet) {
        message << "the level set is at least " << -maximum() << ", above the iso-value " << iso();
    } else {
        message << "the density is at most " << maximum() << ", below the iso-value " << iso();
    }
    return message.str();
}

std::unique_ptr<DensityProbe> SurfaceObject::probe() const {
    return mField ? mField->reconstruction->probe() : nullptr;
}

// Keeps t: a length in world units, whatever the voxels' shape.
Ray SurfaceObject::toIndex(const Ray& ray) const {
    return {mToIndex.transform(ray.origin), mToIndex.transform3x3(ray.direction)};
}

SurfaceHit SurfaceObject::toWorld(const RayHit& hit, const Ray& ray) const {
    // Where a ray starts inside, as an eye may, the surface faces it.
    SurfaceHit found{hit.t, -ray.direction};
    if (hit.t > 0 && hit.gradient.length() > mFlat) {
        found.normal = -grid().transform().baseMap()->applyIJT(hit.gradient).unit();
    }
    return found;
}

std::optional<SurfaceHit> SurfaceObject::entry(const Ray& ray, double end,
                                               DensityProbe& probe) const {
    const auto hit = mMarch->firstHit(toIndex(ray), probe, end);
    if (!hit) return std::nullopt;
    return toWorld(*hit, ray);
}

std::optional<SurfaceHit> SurfaceObject::exit(const Ray& ray, double end,
                                              DensityProbe& probe) const {
    const auto hit = mMarch->firstExit(toIndex(ray), probe, end);
    if (!hit) return std::nullopt;
    return toWorld(*hit, ray);
}

bool SurfaceObject::contains(const Vec3d& place, DensityProbe& probe) const {
    return probe.value(mToIndex.transform(place)) >= mDrawable.iso;
}

Vec3d SurfaceObject::colorAt(const Vec3d& place) const {
    if (!mColors) return mMaterial.color;
    return mColors->at(place).value_or(mMaterial.color);
}

}  // namespace bandvox
