#pragma once

#include "source/shape_tree.h"

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace bandvox {

/// Part of a line start + t·step, by its parameter.
struct LineInterval {
    /// Keeps only where value + slope·t ≤ 0.
    void clip(double value, double slope);
    bool isEmpty() const { return !(low <= high); }

    double low, high;
};

/// A row of points along a line, of which those inside a solid are being set to 1.
class SolidRow {
  public:
    /// Sets all values to 0.
    SolidRow(const openvdb::Vec3d& first, const openvdb::Vec3d& toNext, std::span<float> values);

    /// Sets the points of an interval to 1.
    void fill(const LineInterval& inside);

    /// All of the row, and as little as possible beside.
    LineInterval whole() const;

    std::size_t size() const { return mValues.size(); }

    const openvdb::Vec3d start, step;  ///< world units

  private:
    std::span<float> mValues;
    double mSlack;  // by how much intervals are lengthened, steps
};

/// A solid in [-1, 1]³ that knows where a line runs inside of it.
///
/// A point whose distance from the surface is no more than rounding belongs to the solid, so that
/// a row gives the same values wherever it begins.
class SolidFormula {
  public:
    virtual ~SolidFormula() = default;

    /// Fills the row where it runs inside.
    virtual void cross(SolidRow& row) const = 0;

    /// True or false if all of `box` is certain to be inside or outside.
    virtual std::optional<bool> constantIn(const openvdb::BBoxd& box) const = 0;
};

/// Balls of one radius that do not touch.
class BallsFormula final : public SolidFormula {
  public:
    BallsFormula(std::vector<openvdb::Vec3d> centers, double radius)
        : mCenters(std::move(centers)), mRadius(radius) {}
    void cross(SolidRow& row) const override;
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const override;

  private:
    std::vector<openvdb::Vec3d> mCenters;
    double mRadius;
};

/// The cube [-half, half]³.
class CubeFormula final : public SolidFormula {
  public:
    explicit CubeFormula(double halfSide) : mHalf(halfSide) {}
    void cross(SolidRow& row) const override;
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const override;

  private:
    double mHalf;
};

/// A torus about the y axis.
class TorusFormula final : public SolidFormula {
  public:
    /// `ring`: radius of the tube's middle line; `tube`: radius of the tube.
    TorusFormula(double ring, double tube) : mRing(ring), mTube(tube) {}
    void cross(SolidRow& row) const override;
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const override;

  private:
    bool contains(const openvdb::Vec3d& point) const;
    void crossAcross(SolidRow& row, int axis) const;
    void crossAlong(SolidRow& row) const;

    double mRing, mTube;
};

/// x² + z² ≤ waist² + slope²·y² for -1 ≤ y ≤ 1.
class HyperboloidFormula final : public SolidFormula {
  public:
    HyperboloidFormula(double waist, double slope) : mWaist(waist), mSlope(slope) {}
    void cross(SolidRow& row) const override;
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const override;

  private:
    double mWaist, mSlope;
};

/// The tree; refers to a shape that outlives it.
class TreeFormula final : public SolidFormula {
  public:
    explicit TreeFormula(const TreeShape& tree) : mTree(tree) {}
    void cross(SolidRow& row) const override { mTree.cross(row); }
    std::optional<bool> constantIn(const openvdb::BBoxd& box) const override {
        return mTree.constantIn(box);
    }

  private:
    const TreeShape& mTree;
};

/// Distances up to this are rounding, world units; boxes are told about with twice the margin.
inline constexpr double kOnSurface = 1e-9;
inline constexpr double kBoxMargin = 2 * kOnSurface;

}  // namespace bandvox
