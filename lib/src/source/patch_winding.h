#pragma once

#include "source/box_tree.h"
#include "source/control_net.h"

#include <bandvox/source/bezier_patch.h>

#include <openvdb/math/BBox.h>

#include <array>
#include <memory>
#include <vector>

namespace bandvox {

/// How often closed patches wind around a point: 1 inside. By the crossings of a ray with the
/// patches themselves, found by halving until Newton's method has one root at most to find.
class PatchWinding {
  public:
    /// Closed patches, and the box that holds them. Parts of patches are no larger than `size`.
    PatchWinding(const std::vector<const BezierPatch*>& patches, const openvdb::BBoxd& bounds,
                 double size);

    int at(const openvdb::Vec3d& point) const;

    const openvdb::BBoxd& bounds() const { return mBounds; }

    /// True if a part of the patches may be in the box.
    bool mayMeet(const openvdb::BBoxd& box) const;

    /// A point of a part and its derivatives: along the ray, across and up.
    struct RayJet {
        std::array<double, 3> position, du, dv;
    };

    /// A part of a patch, in the frame of the ray, which runs along x.
    struct Part {
        int degreeU, degreeV;
        ControlNet<4> net;
        bool isPolynomial = false;  ///< all weights are 1
        bool isOneToOne = false;    ///< rays meet it once at most, whatever their place
        RayJet middle{};
        double largestSlope = 0;  ///< along the ray by a parameter, without weights
    };

  private:
    void store(Part part, double size, int depth);

    openvdb::BBoxd mBounds;
    std::vector<Part> mParts;
    std::unique_ptr<const BoxTree> mTree;       ///< of them
    std::unique_ptr<const BoxTree> mWorldTree;  ///< the same in the world
};

}  // namespace bandvox
