#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>
#include <openvdb/math/Mat4.h>

#include <optional>
#include <span>

namespace bandvox {

/// A straight line of sight, world units; `direction` has length 1.
struct Ray {
    openvdb::Vec3d origin;
    openvdb::Vec3d direction;
};

/// Where a picture is taken from. Words and units are those of vdb_render.
struct CameraOptions {
    enum class Projection { Perspective, Orthographic } projection = Projection::Perspective;
    std::optional<openvdb::Vec3d> eye;     ///< world; default: chosen so that the object fits
    std::optional<openvdb::Vec3d> lookat;  ///< world; default: the object is in the middle
    /// World direction that points up in the picture; default: y, or z where the view is along y.
    std::optional<openvdb::Vec3d> up;
    openvdb::Vec3d from{0.55, 0.35, 1};  ///< direction from the object to a chosen eye
    double focal = 50;                   ///< focal length, mm; 1e-3 to 1e6 (perspective)
    double aperture = 41.2136;           ///< width of the film, mm; 1e-3 to 1e6 (perspective)
    double frame = 0;                    ///< width of the view, world; 0 fits (orthographic)
};

/// Throws Error(ErrorKind::Usage) for options that define no view of any object: eye and lookat
/// the same, up along the view, a length that is not positive.
void requireValid(const CameraOptions& options);

/// A camera for pictures of `width` × `height` pixels.
class Camera {
  public:
    /// `object` is the box to frame, world units, not empty.
    /// Throws Error(ErrorKind::Usage) if the options do not define a view of it.
    Camera(const CameraOptions& options, int width, int height, const openvdb::BBoxd& object);

    /// The same with the points to frame, world units, at least one: what is seen of an object
    /// fills the picture better than what is seen of its box. What is looked at by default is the
    /// middle of their box. `faint`: points that are to be in the picture too, with hardly any
    /// room around them, as the edge of a fog where it thins out.
    Camera(const CameraOptions& options, int width, int height,
           std::span<const openvdb::Vec3d> object, std::span<const openvdb::Vec3d> faint = {});

    /// The line of sight through a place of the picture, in pixels from its top left corner.
    Ray ray(double x, double y) const;

    /// Distance of a world point from the plane through the eye, along the view.
    double depth(const openvdb::Vec3d& point) const;

    /// The place of the picture where a world point is seen, in pixels from its top left corner.
    /// Of points behind the eye of a perspective view it has no meaning.
    openvdb::Vec2d project(const openvdb::Vec3d& point) const;

    /// Pixels that a world length across the view takes up at this depth.
    double pixelsPerLength(double depth) const;

    /// Turns world points, rows of coordinates, into the camera's: x right, y up, z along the view.
    openvdb::math::Mat4d worldToCamera() const;
    /// Turns world points into the picture's: x and y from -1 to 1, from the lower left, z from 0
    /// in the eye's plane; under perspective to be divided by the fourth coordinate.
    openvdb::math::Mat4d worldToScreen() const;

    CameraOptions::Projection projection() const { return mProjection; }
    const openvdb::Vec3d& eye() const { return mEye; }
    const openvdb::Vec3d& forward() const { return mForward; }
    const openvdb::Vec3d& right() const { return mRight; }
    const openvdb::Vec3d& upward() const { return mUpward; }

  private:
    CameraOptions::Projection mProjection;
    openvdb::Vec3d mEye, mForward, mRight, mUpward;
    double mPixelsWide, mPixelsHigh;
    double mHalfWidth, mHalfHeight;  // at distance 1 (perspective), or of the view
};

}  // namespace bandvox
