#pragma once

#include "source/cell_trim.h"
#include "source/patch.h"
#include "source/patch_winding.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace bandvox {

/// What the union of pieces leaves of one of them: the part of its surface that has the outside of
/// all pieces before it and a solid behind.
class PatchTrim final : public CellTrim {
  public:
    /// One of the pieces of a union.
    struct Piece {
        std::unique_ptr<const PatchWinding> winding;
        bool isCavity = false;  ///< winds around its inside the other way
    };

    /// Of the piece `own`. Faces that lie on each other to within `distance` (world units) count
    /// once if they look the same way, and not at all otherwise.
    PatchTrim(const std::vector<Piece>& pieces, std::size_t own, double distance)
        : mPieces(pieces), mOwn(own), mDistance(distance) {}

    /// Unknown if other pieces may be in the cell's box.
    Share share(const Patch& patch, const ParameterCell& cell) const override;

    /// Gauss points on what is left of a cell: along lines across the cut, up to where that is, and
    /// over the lines that it passes through, between those where it leaves the cell. Sees no part
    /// that lies between the quarters of a line.
    std::vector<TrimmedPoint> rule(const Patch& patch, const ParameterCell& cell) const override;

  private:
    friend class PieceCell;
    const std::vector<Piece>& mPieces;
    std::size_t mOwn;
    double mDistance;
};

}  // namespace bandvox
