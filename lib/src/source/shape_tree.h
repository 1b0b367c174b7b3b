#pragma once

#include "source/patch.h"

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <optional>
#include <vector>

namespace bandvox {

class SolidRow;

/// A tree that branches in two again and again, up along y, in [-1, 1]³.
///
/// Each branch is a frustum between two horizontal rectangles. Its top is halved, along x and
/// along z in turn, and each half is the foot of a child. All that grows from a half stays on
/// its side of the dividing plane, so branches never overlap, and the surface of the whole is
/// the branches' sides, the trunk's foot and the tops of the last twigs.
class TreeShape {
  public:
    TreeShape();

    /// Fills the row where it runs inside.
    void cross(SolidRow& row) const;

    /// True or false if all of `box` is certain to be inside or outside.
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const;

    double volume() const;

    /// Appends the surface as plane quadrilaterals and returns its area.
    double appendPatches(PatchList& patches) const;

  private:
    /// Horizontal; index 0 is x, index 1 is z.
    struct Rectangle {
        double min[2], max[2];
    };
    struct Branch {
        double y0, y1;
        Rectangle foot, top;
        openvdb::BBoxd bounds;       ///< of it and all that grows from it
        int children[2] = {-1, -1};  ///< both or none
    };

    int grow(const Branch& sprout, const Rectangle& room, const double (&lean)[2], int level);
    void fitToBox();
    void boundBranches();
    template <typename Visitor>
    static void visitPlanes(const Branch& branch, const Visitor& visit);
    void crossBranch(int index, SolidRow& row) const;
    bool isOutside(int index, const openvdb::BBoxd& box, bool& isInside) const;

    std::vector<Branch> mBranches;  ///< the trunk first
};

}  // namespace bandvox
