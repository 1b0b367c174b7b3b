#pragma once

#include "render/facets.h"
#include "render/object_colors.h"
#include "render/ray_march.h"
#include "render/screen_cells.h"
#include "render/surface_blocks.h"
#include "render/surface_field.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

#include <memory>
#include <optional>
#include <string>

namespace bandvox {

/// Where a line of sight meets a surface.
struct SurfaceHit {
    double t = 0;                    ///< along the ray, world units
    openvdb::Vec3d normal{0, 0, 0};  ///< world, unit, out of the solid
};

/// A grid whose surface is seen, ready for lines of sight from many threads.
class SurfaceObject {
  public:
    /// Throws as sceneToImage.
    SurfaceObject(const SceneObject& object, const PictureOptions& options,
                  const Progress& progress = silentProgress());

    const Material& material() const { return mMaterial; }
    const Facets& facets() const { return mFacets; }
    const CoatReflectance& coat() const { return mCoat; }
    /// The same in the grid that was given.
    double iso() const { return mDrawable.isLevelSet ? -mDrawable.iso : mDrawable.iso; }
    /// The value of grid() that is the surface.
    double threshold() const { return mDrawable.iso; }
    /// Larger inside than outside: of a level set a copy with opposite signs.
    const openvdb::FloatGrid& grid() const { return *mDrawable.grid; }
    const SurfaceBlocks& blocks() const { return *mBlocks; }
    /// The shortest side of a voxel, world units.
    double voxel() const { return mVoxel; }
    /// How far from the surface a ray starts or goes on, world units: beyond what places are off
    /// by, well within a voxel.
    double beyond() const { return 0.02 * mVoxel; }

    /// The highest value of the grid; below iso, nothing is to be seen.
    double maximum() const { return mBlocks->maximum(); }
    bool empty() const { return mBlocks->empty(); }
    /// That no value is inside, in words.
    std::string whyEmpty() const;

    std::unique_ptr<DensityProbe> probe() const;
    /// Lines of sight in index coordinates. Not to be asked for if nothing is to be seen.
    const RayMarch& march() const { return *mMarch; }

    /// Where a ray, 0 ≤ t ≤ `end`, enters the solid.
    std::optional<SurfaceHit> entry(const Ray& ray, double end, DensityProbe& probe) const;
    /// Where a ray that starts inside leaves it.
    std::optional<SurfaceHit> exit(const Ray& ray, double end, DensityProbe& probe) const;
    /// True if a place, world units, is inside.
    bool contains(const openvdb::Vec3d& place, DensityProbe& probe) const;

    /// The colour at a place, world units.
    openvdb::Vec3d colorAt(const openvdb::Vec3d& place) const;

  private:
    Ray toIndex(const Ray& ray) const;
    SurfaceHit toWorld(const RayHit& hit, const Ray& ray) const;

    std::string mName;
    Material mMaterial;
    Facets mFacets;
    CoatReflectance mCoat;
    DrawableGrid mDrawable;
    openvdb::Mat4d mToIndex;
    double mVoxel;
    std::unique_ptr<SurfaceBlocks> mBlocks;
    std::optional<SurfaceField> mField;  // none if there is nothing to see
    std::optional<RayMarch> mMarch;
    std::optional<ObjectColors> mColors;
    double mFlat = 0;  // gradients below this have no direction worth showing
};

}  // namespace bandvox
