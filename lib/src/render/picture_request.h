#pragma once

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/render/density_to_image.h>

#include <openvdb/math/BBox.h>

#include <optional>
#include <vector>

namespace bandvox {

/// Throws Error(ErrorKind::Input) unless `grid` is one that can be drawn.
void requireDrawable(const openvdb::FloatGrid& grid);

/// Throws Error(ErrorKind::Input), for a grid that has values that are not finite.
[[noreturn]] void failNotFinite(const openvdb::FloatGrid& grid);

/// True if a float can be between a background and an iso-value above it. Else blocks of nothing
/// but background would be looked at for a surface.
bool isAboveBackground(double iso, float background);

/// The density that is the surface. Throws unless it is above the background:
/// Error(ErrorKind::Usage) if it comes from the options, Error(ErrorKind::Input) otherwise.
double isoOf(const openvdb::FloatGrid& grid, const std::optional<DensityMetadata>& metadata,
             const std::optional<double>& iso);

/// Throws the error that is being handled as one about an object: what it says begins with the
/// object's name, unless that is that the work was interrupted.
[[noreturn]] void failNamed(const SceneObject& object, const Error& error);

/// The shortest side of a voxel, world units.
double shortestVoxelSide(const openvdb::FloatGrid& grid);

/// The box of the active voxels, world units. Throws Error(ErrorKind::Input) if it is not finite.
openvdb::BBoxd worldBox(const openvdb::FloatGrid& grid);

/// False if the options define a view whatever is to be seen.
bool needsFraming(const CameraOptions& camera);

/// The corners of what is active, node by node, world units: points to frame in a picture.
std::vector<openvdb::Vec3d> activePoints(const openvdb::FloatGrid& grid,
                                         const Progress& progress = silentProgress());

/// Points to frame in a picture, world units.
struct FramedPoints {
    std::vector<openvdb::Vec3d> active;  ///< activePoints of all objects of a scene
    std::vector<openvdb::Vec3d> faint;   ///< how far the averages reach that volumes are read by
};
FramedPoints pointsToFrame(const Scene& scene, const Progress& progress = silentProgress());

/// Throws Error(ErrorKind::Result), for a grid whose values reach no more than `maximum`.
[[noreturn]] void failEmpty(double maximum, double iso);

/// Throws Error(ErrorKind::Result) if nothing was hit; `maximum` is the highest value of the grid.
void requireHits(const RenderResult& result, double maximum, double iso);

}  // namespace bandvox
