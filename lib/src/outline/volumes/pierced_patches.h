#pragma once

#include "outline/patches/isophotes.h"
#include "outline/volumes/volume_equations.h"

#include <bandvox/core/progress.h>

#include <vector>

namespace bandvox {

/// Where patches pass through the surface of a volume: {f~(S(u, v)) = d}, followed from cell to
/// cell of a lattice of parameters whose cells are no larger than half a voxel, and joined across
/// patches. A loop smaller than that may be missed. Points are on `patch` at (u, v), and `other` is
/// the number of the volume.
std::vector<Curve> piercingCurves(const LitPatches& lit, const VolumeSurface& surface,
                                  const CurveSampling& sampling, Progress& progress);

/// Finds exact points of such curves, for one thread.
class PiercingFinder {
  public:
    /// Both are kept by reference.
    PiercingFinder(const LitPatches& lit, const VolumeSurface& surface);

    /// The exact point between two of one patch, at a share of the way.
    CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share);

    /// f~ - d at a place of a patch, and its derivatives by the parameters.
    Gradient2 at(int patch, double u, double v);

    /// The point of a curve there.
    CurvePoint seen(int patch, double u, double v);

  private:
    const LitPatches& mLit;
    const VolumeSurface& mSurface;
    std::unique_ptr<DensityProbe> mProbe;
    openvdb::Mat4d mToIndex;
};

}  // namespace bandvox
