#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/oriented_points_to_solid_grid.h>

#include <openvdb/openvdb.h>

#include <memory>
#include <span>

namespace bandvox {

/// An indicator function of oriented points: below 0 inside, above 0 outside. Apart from what uses
/// it, since its headers take long to compile.
class PoissonFunction {
  public:
    /// The normals are of length 1. Throws as orientedPointsToSolidGrid does.
    PoissonFunction(const OrientedPoints& points, Progress& progress);
    ~PoissonFunction();
    PoissonFunction(const PoissonFunction&) = delete;
    PoissonFunction& operator=(const PoissonFunction&) = delete;

    /// Mean distance of a point from the six nearest, world units.
    double spacing() const;

    /// The values at places, world units, each near the one before. The same wherever else places
    /// are read, by any thread.
    void read(std::span<const openvdb::Vec3d> places, std::span<float> values) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> mImplementation;
};

}  // namespace bandvox
