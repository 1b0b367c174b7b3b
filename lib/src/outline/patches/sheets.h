#pragma once

#include "outline/drawing/curve.h"
#include "outline/patches/view_patch.h"
#include "source/control_net.h"
#include "source/face_regions.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace bandvox {

/// Answers which patches a line of sight meets. Patches are cut into parts on each of which the map
/// (u, v) -> (X, Y) is one-to-one by bounds of its derivatives, so that Newton's method finds the
/// one place, or that there is none; where a patch folds, parts are cut on while a line is
/// followed. Many threads may ask at once.
class Sheets {
  public:
    /// Both are kept by reference. Of patches that belong to faces only these are met.
    explicit Sheets(std::span<const ViewPatch> patches, const FaceRegions* faces = nullptr);

    /// How many times the line of sight to a point of a curve meets patches that are nearer than it
    /// by more than `margin`. Where a patch folds within 1/131072 of its parameters it is not met.
    int countBefore(const CurvePoint& point, double margin) const;

    /// The same, but patches of these faces have to be nearer by `ownMargin`.
    int countBefore(const CurvePoint& point, double margin, std::span<const int> ownFaces,
                    double ownMargin) const;

    /// A place of a patch, and its depth.
    struct Place {
        int patch = -1;
        double u = 0, v = 0, z = 0;
    };

    /// What the line of sight at a place of the page meets first; of objects in the same place the
    /// one of the lowest number.
    std::optional<Place> firstAt(double x, double y) const;

    /// A part of a patch, as the page sees it.
    struct Part {
        int patch = 0;
        int m = 0, n = 0;  ///< degrees
        double u0 = 0, v0 = 0, size = 1;
        ControlNet<3> points;       ///< on the page
        ControlNet<4> homogeneous;  ///< empty if not rational
        double x0 = 0, x1 = 0, y0 = 0, y1 = 0, z0 = 0;
        bool oneToOne = false;
        /// Of a one-to-one part: its middle on the page, the inverse of a mean derivative, and by
        /// how much derivatives differ from that at most, relatively.
        double middleX = 0, middleY = 0;
        std::array<double, 4> inverse{};
        double bend = 0;
    };

  private:
    struct Sight;
    void cutPart(Part part, int depth, std::vector<Part>& parts) const;
    void meet(const Part& part, Sight& sight) const;
    void meetCut(const Part& part, Sight& sight) const;
    void meetAll(Sight& sight) const;
    double sameDepth() const { return 1e-9 * kCells * (mCellWidth + mCellHeight); }
    std::size_t column(double x) const;
    std::size_t row(double y) const;

    static constexpr int kCells = 64;  // along a side of the page

    std::span<const ViewPatch> mPatches;
    const FaceRegions* mFaces;
    std::vector<Part> mParts;
    double mLeft = 0, mTop = 0, mCellWidth = 1, mCellHeight = 1;
    std::vector<std::vector<std::uint32_t>> mCells;  // parts by the place that they may cover
};

}  // namespace bandvox
