#include "core/words.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/grid/balls_to_solid_grid.h>

#include <openvdb/thread/Threading.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/ParticlesToLevelSet.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

using openvdb::Vec3d;

namespace {

/// Half of the band around the surface that is computed. Where marching cubes looks for the surface
/// it is less than a voxel away.
constexpr double kBallBand = 2;

/// The smallest ball, in voxels of the lattice; OpenVDB takes no smaller one by default.
constexpr double kSmallestBall = 1.5;

/// Larger ones are drawn as shells, since their inside would take time and memory; in voxels.
constexpr double kLargestSolidBall = 32;

/// What a leaf takes while balls are drawn, with its share of the tree.
constexpr double kBytesPerLeaf = 2600;

/// What a lattice may take that is finer than large balls need. The same on every machine.
constexpr double kFinerBytes = 2e9;

/// Voxels of the lattice along a voxel of the density.
constexpr std::array kBallFactors{2.0, 4.0, 8.0};

constexpr double kFarthestIndex = 1e9;

double ballVolume(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// Lets OpenVDB stop when the caller wants to.
class BallInterrupter {
  public:
    explicit BallInterrupter(Progress& progress) : mProgress(progress) {}
    void start(const char* = nullptr) {}
    void end() {}
    bool wasInterrupted(int = -1) const { return mProgress.interrupted(); }

  private:
    Progress& mProgress;
};

/// The balls that ParticlesToLevelSet draws, as it asks for them.
class DrawnBalls {
  public:
    using PosType = openvdb::Vec3R;

    /// Their places are told relative to `origin`, world units.
    DrawnBalls(const Balls& balls, std::vector<std::uint32_t> chosen, const Vec3d& origin,
               double voxel, Progress& progress)
        : mBalls(balls),
          mChosen(std::move(chosen)),
          mOrigin(origin),
          mVoxel(voxel),
          mProgress(progress) {}

    std::size_t size() const { return mChosen.size(); }
    void getPos(std::size_t n, openvdb::Vec3R& place) const {
        place = mBalls.centers[mChosen[n]] - mOrigin;
    }
    void getPosRad(std::size_t n, openvdb::Vec3R& place, openvdb::Real& radius) const {
        getPos(n, place);
        radius = enlarged(mBalls.radii[mChosen[n]], mVoxel);
        constexpr std::int64_t kStep = 1024;
        if (++mDrawn % kStep == 0) mProgress.advance(kStep);
    }

    /// What has to be drawn for marching cubes to enclose the volume of a ball.
    static double enlarged(double radius, double voxel) {
        constexpr double kCutOff = 0.2;  // voxels · radius in voxels, on the mean
        return radius + kCutOff * voxel * voxel / radius;
    }

  private:
    const Balls& mBalls;
    std::vector<std::uint32_t> mChosen;
    Vec3d mOrigin;
    double mVoxel;
    Progress& mProgress;
    mutable std::atomic<std::int64_t> mDrawn{0};
};

/// Leaves that the balls touch on a lattice, at most.
double leavesTouched(const Balls& balls, double voxel) {
    openvdb::MaskTree touched;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(touched);
    const double block = 8 * voxel;
    double shells = 0;
    for (std::size_t i = 0; i < balls.radii.size(); ++i) {
        const double radius = balls.radii[i] / voxel;
        if (radius < kSmallestBall) continue;
        if (radius > kLargestSolidBall) {
            shells += 4 * std::numbers::pi * radius * radius * (2 * kBallBand + 8) / 512;
            continue;
        }
        const Vec3d reach(balls.radii[i] + kBallBand * voxel);
        const auto low = openvdb::Coord::floor((balls.centers[i] - reach) / block);
        const auto high = openvdb::Coord::floor((balls.centers[i] + reach) / block);
        // Most of them are touched by the ball before as well.
        if (accessor.isValueOn(low) && accessor.isValueOn(high)) continue;
        for (auto place = openvdb::CoordBBox(low, high).begin(); place; ++place) {
            accessor.setValueOn(*place);
        }
    }
    return double(touched.activeVoxelCount()) + shells;
}

/// The coarsest lattice that holds the smallest ball, or the finest that is not too large.
double chooseBallLattice(const Balls& balls, double voxelSize) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const double radius : balls.radii) {
        if (radius > 0) smallest = std::min(smallest, radius);
    }
    double voxel = voxelSize / kBallFactors.front();
    for (const double factor : kBallFactors) {
        const double finer = voxelSize / factor;
        const bool mayBeTaken = kBytesPerLeaf * leavesTouched(balls, finer) < kFinerBytes;
        if (!mayBeTaken && factor != kBallFactors.front()) break;
        voxel = finer;
        if (smallest >= kSmallestBall * voxel) break;
    }
    requireMemory(kBytesPerLeaf * leavesTouched(balls, voxel), "the lattice of the balls");
    return voxel;
}

/// The union of level sets that come one after another. Two of as many are united at a time, so
/// that none is gone through more often than the logarithm of their number.
class GrowingUnion {
  public:
    void add(openvdb::FloatGrid::Ptr grid) {
        std::size_t size = 0;
        for (; size < mParts.size() && mParts[size]; ++size) grid = united(mParts[size], grid);
        if (size == mParts.size()) mParts.emplace_back();
        mParts[size] = std::move(grid);
    }

    /// All of them, and nothing is left; null if there was none.
    openvdb::FloatGrid::Ptr finish() {
        openvdb::FloatGrid::Ptr all;
        for (openvdb::FloatGrid::Ptr& part : mParts) {
            if (part) all = all ? united(part, all) : std::move(part);
            part.reset();
        }
        return all;
    }

  private:
    static openvdb::FloatGrid::Ptr united(openvdb::FloatGrid::Ptr& into,
                                          openvdb::FloatGrid::Ptr& other) {
        openvdb::tools::csgUnion(*into, *other, /*prune=*/true);
        other.reset();
        return std::move(into);
    }

    std::vector<openvdb::FloatGrid::Ptr> mParts;  // of 2^i grids, or none
};

void requireNear(const Balls& balls, double voxel) {
    const openvdb::BBoxd box = balls.bounds();
    const Vec3d low = openvdb::math::Abs(box.min());
    const Vec3d high = openvdb::math::Abs(box.max());
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) reach = std::max({reach, low[axis], high[axis]});
    if (reach / voxel < kFarthestIndex) return;
    throw Error(ErrorKind::Input, "the balls reach to " + inShort(reach) + " from the origin, " +
                                      inShort(reach / voxel) + " voxels of side " + inShort(voxel) +
                                      "; expected fewer than " + inShort(kFarthestIndex));
}

}  // namespace

openvdb::BBoxd Balls::bounds() const {
    openvdb::BBoxd box;
    for (std::size_t i = 0; i < centers.size(); ++i) {
        box.expand(centers[i] - Vec3d(radii[i]));
        box.expand(centers[i] + Vec3d(radii[i]));
    }
    return box;
}

BallGrid ballsToSolidGrid(const Balls& balls, double voxelSize, Progress& progress) {
    if (!(voxelSize > 0)) {
        throw Error(ErrorKind::Usage,
                    "the voxel size for balls is " + inShort(voxelSize) + "; expected more than 0");
    }
    if (balls.centers.size() != balls.radii.size()) {
        throw Error(ErrorKind::Usage,
                    "there are " + std::to_string(balls.centers.size()) + " centers of balls and " +
                        std::to_string(balls.radii.size()) + " radii; expected as many");
    }
    const ProgressStage stage(progress, "drawing balls",
                              static_cast<std::int64_t>(balls.radii.size()));
    requireNear(balls, voxelSize / kBallFactors.back());
    const double voxel = chooseBallLattice(balls, voxelSize);

    BallGrid result;
    std::vector<std::uint32_t> solid, shells;
    for (std::size_t i = 0; i < balls.radii.size(); ++i) {
        const double radius = balls.radii[i];
        if (radius < kSmallestBall * voxel) {
            ++result.tooSmall;
            result.lostVolume += ballVolume(radius);
        } else {
            (radius > kLargestSolidBall * voxel ? shells : solid)
                .push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (solid.empty() && shells.empty()) {
        throw Error(ErrorKind::Result,
                    "all " + counted(balls.radii.size(), "ball is", "balls are") +
                        " smaller than " + inShort(kSmallestBall * voxel) +
                        " in radius, which is the least for voxels of side " + inShort(voxelSize) +
                        "; expected larger ones, or smaller voxels");
    }

    // Draw what is small all at once, and each large ball as the shell that it is. That is done in
    // single precision, so the lattice begins in their midst.
    const Vec3d origin = balls.bounds().getCenter();
    result.grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxel, kBallBand);
    BallInterrupter interrupter(progress);
    const DrawnBalls drawn(balls, std::move(solid), origin, voxel, progress);
    using Drawing = openvdb::tools::ParticlesToLevelSet<openvdb::FloatGrid, void, BallInterrupter>;
    Drawing drawing(*result.grid, &interrupter);
    drawing.setRmax(2 * kLargestSolidBall);
    if (drawn.size() > 0) drawing.rasterizeSpheres(drawn);
    progress.throwIfInterrupted();
    drawing.finalize(/*prune=*/true);
    GrowingUnion large;
    for (const std::uint32_t i : shells) {
        progress.throwIfInterrupted();
        large.add(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
            static_cast<float>(DrawnBalls::enlarged(balls.radii[i], voxel)),
            openvdb::Vec3f(balls.centers[i] - origin), static_cast<float>(voxel),
            static_cast<float>(kBallBand)));
        progress.advance();
    }
    if (const auto all = large.finish()) {
        openvdb::tools::csgUnion(*result.grid, *all, /*prune=*/true);
    }
    result.grid->transform().postTranslate(origin);
    result.grid->setName("balls");
    return result;
}

}  // namespace bandvox
