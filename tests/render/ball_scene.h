#pragma once

#include <bandvox/render/density_to_image.h>
#include <bandvox/spectral/exponential_filter.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <functional>

// What the tests of pictures look at: a ball whose density has a closed form.
namespace bandvox::render_test {

constexpr double kRadius = 17.3;                  ///< of the ball, in voxels
const openvdb::Vec3d kCenter(20.2, 19.6, -20.7);  ///< of the ball, in index coordinates

/// A density at index coordinates, on all voxels of a box where it is above the tolerance.
openvdb::FloatGrid::Ptr makeGrid(const openvdb::CoordBBox& box, const ExponentialFilter& filter,
                                 const std::function<double(const openvdb::Vec3d&)>& density);

/// The density, at distance r from its middle, of a ball filtered with the default filter, which
/// is a Gaussian; voxels.
double ballDensity(double r, double radius);

/// The distance at which the filtered ball's density is iso, in voxels.
double ballSurface(double radius, double iso);

/// The ball of kRadius at kCenter; a voxel is one world unit.
openvdb::FloatGrid::Ptr ballGrid();

RenderOptions smallPicture(int width = 120, int height = 90);

/// A square picture of `side` pixels, `frame` voxels wide, of the ball from 60 voxels in front of
/// it, along -z.
RenderOptions frontView(int side, double frame);

openvdb::Vec3d normalAt(const Image& image, std::size_t pixel);
openvdb::Vec3d positionAt(const Image& image, std::size_t pixel);

}  // namespace bandvox::render_test
