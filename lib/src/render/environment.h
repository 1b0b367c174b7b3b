#pragma once

#include "core/image_library.h"

#include <bandvox/render/scene.h>

#include <openvdb/Types.h>

#include <array>
#include <string>
#include <vector>

namespace bandvox {

/// See readEnvironmentMap.
class EnvironmentMap {
  public:
    /// Throws Error(ErrorKind::Input), naming it, for values that are negative or not finite.
    EnvironmentMap(PixelArray pixels, double turn, const std::string& name);

    /// The light that comes from a direction, of length 1, interpolated between the pixels.
    openvdb::Vec3d radiance(const openvdb::Vec3d& direction) const;

    /// What a white matt surface of this normal sends out of it if nothing is in the way.
    ///
    /// R. Ramamoorthi, P. Hanrahan: "An Efficient Representation for Irradiance Environment Maps"
    /// (2001): by the first nine spherical harmonics, within 1 % on average, 9 % at most.
    openvdb::Vec3d irradiance(const openvdb::Vec3d& normal) const;

    /// The mean over all directions.
    openvdb::Vec3d mean() const;

    /// A direction drawn by brightness, and how often it is, per solid angle.
    struct Sample {
        openvdb::Vec3d direction;
        double density;
    };
    Sample sample(const openvdb::Vec2d& u) const;
    /// How often `sample` gives a direction.
    double density(const openvdb::Vec3d& direction) const;

  private:
    void project();
    openvdb::Vec3d inMap(const openvdb::Vec3d& direction) const;
    openvdb::Vec3d pixel(int column, int row) const;
    openvdb::Vec3d toMap(const openvdb::Vec3d& direction) const;
    openvdb::Vec2d placeOf(const openvdb::Vec3d& direction) const;

    PixelArray mPixels;
    double mSine, mCosine;         // of the turn
    std::vector<double> mRows;     // brightness of the rows up to each, 0 first, 1 last
    std::vector<double> mColumns;  // [height][width + 1], the same in each row
    std::array<openvdb::Vec3d, 9> mHarmonics{};
};

}  // namespace bandvox
