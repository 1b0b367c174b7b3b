#pragma once

#include "source/patch.h"
#include "source/patch_winding.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace bandvox {

/// What the union of pieces leaves of one of them: the part of its surface that has the outside of
/// all pieces before it and a solid behind.
class PatchTrim {
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

  private:
    friend class CellTrim;
    const std::vector<Piece>& mPieces;
    std::size_t mOwn;
    double mDistance;
};

/// What a trim leaves of one cell of a patch. Pieces that are not near it wind as often around all
/// of it, and are asked once.
class CellTrim {
  public:
    CellTrim(const PatchTrim& trim, const Patch& patch, const ParameterCell& cell);

    const ParameterCell& cell() const { return mCell; }
    const Patch& patch() const { return mPatch; }

    /// True if no other piece is near: all points of the cell are left, or none.
    bool isUniform() const { return mNear.empty(); }

    /// True if the point of the cell is left.
    bool keeps(double u, double v) const;

  private:
    openvdb::Vec3d normalAt(const PatchPoint& p, double u, double v) const;

    const PatchTrim& mTrim;
    const Patch& mPatch;
    ParameterCell mCell;
    int mAround;  ///< how often its own piece, seen from before it, and those that are not near
                  ///< wind
    std::vector<std::size_t> mNear;
};

/// A point of a product rule on what is left of a cell: parameters and weight, of which those of
/// the whole cell add up to its area in parameters.
struct TrimmedPoint {
    double u, v, weight;
};

/// Gauss points on what is left of a cell: along lines across the cut, up to where that is, and
/// over the lines that it passes through, between those where it leaves the cell. `points` each
/// way, as in intervalRule. Sees no part that lies between the quarters of a line.
std::vector<TrimmedPoint> trimmedRule(const CellTrim& trim);

}  // namespace bandvox
