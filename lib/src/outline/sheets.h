#pragma once

#include "outline/view_patch.h"

#include <cstddef>
#include <span>
#include <vector>

namespace bandvox {

/// Answers which patches a line of sight meets. Patches are cut into parts on each of which the map
/// (u, v) -> (X, Y) is one-to-one by bounds of its derivatives, so that Newton's method finds the
/// one place, or that there is none; where a patch folds, parts are cut on while a line is
/// followed. Many threads may ask at once.
class Sheets {
  public:
    /// The patches are kept by reference.
    explicit Sheets(std::span<const ViewPatch> patches);

    /// How many times the line of sight through (x, y) of the page meets patches before depth z.
    int countBefore(double x, double y, double z) const;

    /// The least and the largest depth of all patches.
    double nearest() const { return mNearest; }
    double farthest() const { return mFarthest; }

    /// A part of a patch, as the page sees it.
    struct Part {
        int patch = 0;
        double u0 = 0, v0 = 0, size = 1;
        Bernstein2 x, y, z, w;
        double x0 = 0, x1 = 0, y0 = 0, y1 = 0, z0 = 0;
        bool oneToOne = false;
    };

  private:
    void addPart(Part part, int depth);
    int countIn(const Part& part, const std::array<double, 3>& target) const;
    std::size_t column(double x) const;
    std::size_t row(double y) const;

    std::span<const ViewPatch> mPatches;
    std::vector<Part> mParts;
    double mLeft = 0, mTop = 0, mCellWidth = 1, mCellHeight = 1;
    std::vector<std::vector<std::size_t>> mCells;  // parts by the place that they may cover
    double mNearest = 0, mFarthest = 0;
};

}  // namespace bandvox
