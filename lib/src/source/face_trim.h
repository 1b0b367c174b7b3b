#pragma once

#include "source/cell_trim.h"
#include "source/face_regions.h"

namespace bandvox {

/// What belongs to its face of a patch.
class FaceTrim final : public CellTrim {
  public:
    /// The regions are kept by reference.
    FaceTrim(const FaceRegions& regions, int patch) : mRegions(regions), mPatch(patch) {}

    Share share(const Patch& patch, const ParameterCell& cell) const override;

    /// By lines along u, of which the loops cut off the ends: between places where the loops turn
    /// back, begin or leave the cell these are smooth from line to line, but for square roots at
    /// turns, which lines that lie denser towards both ends make smooth.
    std::vector<TrimmedPoint> rule(const Patch& patch, const ParameterCell& cell) const override;

  private:
    const FaceRegions& mRegions;
    int mPatch;
};

}  // namespace bandvox
