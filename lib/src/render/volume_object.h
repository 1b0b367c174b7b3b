#pragma once

#include "render/object_colors.h"
#include "render/volume_blocks.h"

#include <bandvox/core/progress.h>
#include <bandvox/reconstruct/reconstruction.h>
#include <bandvox/render/picture_options.h>
#include <bandvox/render/scene.h>

#include <memory>
#include <optional>
#include <string>

namespace bandvox {

/// What reads a volume, for one thread.
struct VolumeProbe {
    std::unique_ptr<DensityProbe> density;
    std::unique_ptr<DensityProbe> temperature;  ///< null if there is none
};

/// A grid that light goes through, ready for lines of sight from many threads. Places and lengths
/// are in world units.
class VolumeObject {
  public:
    /// Throws as sceneToImage.
    VolumeObject(const SceneObject& object, const PictureOptions& options,
                 const Progress& progress = silentProgress());

    bool empty() const { return mBlocks->empty(); }
    /// That no density is seen, in words.
    std::string whyEmpty() const;
    const openvdb::FloatGrid& grid() const { return *mGrid; }
    /// The shortest side of a voxel.
    double voxel() const { return mVoxel; }
    /// True of a density of this library: it holds nothing near half a cycle per voxel.
    bool isBandLimited() const { return mIsBandLimited; }
    double anisotropy() const { return mMedium.anisotropy; }
    bool glows() const;

    VolumeProbe probe() const;

    /// The part of light that is stopped per world unit at a place.
    double extinctionAt(const openvdb::Vec3d& place, VolumeProbe& probe) const;
    /// What of it is scattered, by colour.
    openvdb::Vec3d colorAt(const openvdb::Vec3d& place) const;
    /// The light that so much of it shines with that nothing passes.
    openvdb::Vec3d glowAt(const openvdb::Vec3d& place, VolumeProbe& probe) const;

    /// Calls `visit(t0, t1, most)` for the parts of a ray, 0 ≤ t ≤ `end`, in which the extinction
    /// is more than nothing, and `most` at most; stops when it returns true.
    template <typename Visitor>
    void walk(const Ray& ray, double end, const Visitor& visit) const {
        mBlocks->walk(toIndex(ray), end, [&](double t0, double t1, double most) {
            return visit(t0, t1, mExtinction * most);
        });
    }

  private:
    Ray toIndex(const Ray& ray) const {
        return {mToIndex.transform(ray.origin), mToIndex.transform3x3(ray.direction)};
    }

    std::string mName;
    openvdb::FloatGrid::ConstPtr mGrid;
    Medium mMedium;
    openvdb::Mat4d mToIndex;
    double mVoxel;
    double mExtinction;
    bool mIsBandLimited;
    std::unique_ptr<VolumeBlocks> mBlocks;
    std::unique_ptr<Reconstruction> mDensity;
    std::unique_ptr<Reconstruction> mTemperature;
    openvdb::Mat4d mToTemperature;  // from the world to the index coordinates of the temperatures
    std::optional<ObjectColors> mColors;
};

}  // namespace bandvox
