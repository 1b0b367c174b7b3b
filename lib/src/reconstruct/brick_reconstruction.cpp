#include "core/rounding.h"
#include "core/words.h"
#include "reconstruct/brick_cache.h"
#include "reconstruct/coefficient_brick.h"
#include "reconstruct/interpolation_design.h"

#include <bandvox/core/error.h>
#include <bandvox/reconstruct/brick_reconstruction.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace bandvox {

namespace {

// Places farther from the origin than this, in voxels, read as the grid's background: index
// coordinates have 32 bits, and a halo must fit.
constexpr double kFarthest = 1 << 30;

// The last place of a brick along an axis.
constexpr double kLastPlace = CoefficientBrick::kSide - 1e-9;

class BrickProbe final : public DensityProbe {
  public:
    BrickProbe(BrickCache& cache, double background) : mCache(cache), mBackground(background) {}

    double value(const openvdb::Vec3d& index) override {
        openvdb::Vec3d local;
        const CoefficientBrick* brick = find(index, local);
        return brick ? brick->value(mCache.kernel(), local) : mBackground;
    }

    DensityAt evaluate(const openvdb::Vec3d& index) override {
        openvdb::Vec3d local;
        const CoefficientBrick* brick = find(index, local);
        return brick ? brick->evaluate(mCache.kernel(), local) : DensityAt{mBackground, {0, 0, 0}};
    }

    DensityExpansion expand(const openvdb::Vec3d& index) override {
        openvdb::Vec3d local;
        const CoefficientBrick* brick = find(index, local);
        if (!brick) return {mBackground, {0, 0, 0}, openvdb::Mat3d::zero()};
        return brick->expand(mCache.kernel(), local);
    }

  private:
    const CoefficientBrick* find(const openvdb::Vec3d& index, openvdb::Vec3d& local) {
        openvdb::Coord place;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(index[axis]) < kFarthest)) return nullptr;
            place[axis] = floorToInt(index[axis] / CoefficientBrick::kSide);
            // A place a hair below 0 would round up to the end of its brick.
            local[axis] =
                std::min(index[axis] - double(place[axis]) * CoefficientBrick::kSide, kLastPlace);
        }
        // One slot for each parity of a place, so that the eight bricks around a corner all stay.
        Last& last = mLast[(place[0] & 1) * 4 + (place[1] & 1) * 2 + (place[2] & 1)];
        if (!last.brick || last.place != place) {
            last.brick = mCache.brick(place, mScratch);
            last.place = place;
        }
        if (!last.brick->holds(local)) last.brick = mCache.wholeBrick(place, mScratch);
        return last.brick.get();
    }

    struct Last {
        openvdb::Coord place;
        BrickCache::BrickPtr brick;
    };

    BrickCache& mCache;
    double mBackground;
    std::array<Last, 8> mLast;
    BrickScratch mScratch;
};

class BrickReconstruction final : public Reconstruction {
  public:
    BrickReconstruction(openvdb::FloatGrid::ConstPtr grid, InterpolationDesign design,
                        const std::optional<DensityBand>& mostlyRead, std::size_t cacheBytes)
        : mBackground(grid->background()),
          mCache(std::move(grid), std::move(design), mostlyRead, cacheBytes) {}

    double value(const openvdb::Vec3d& index) const override {
        return BrickProbe(mCache, mBackground).value(index);
    }

    DensityAt evaluate(const openvdb::Vec3d& index) const override {
        return BrickProbe(mCache, mBackground).evaluate(index);
    }

    DensityExpansion expand(const openvdb::Vec3d& index) const override {
        return BrickProbe(mCache, mBackground).expand(index);
    }

    std::unique_ptr<DensityProbe> probe() const override {
        return std::make_unique<BrickProbe>(mCache, mBackground);
    }

  private:
    double mBackground;
    mutable BrickCache mCache;
};

void requireGrid(const openvdb::FloatGrid::ConstPtr& grid) {
    if (!grid) throw Error(ErrorKind::Usage, "a reconstruction needs a grid, but got none");
}

}  // namespace

std::unique_ptr<Reconstruction> makeBrickReconstruction(openvdb::FloatGrid::ConstPtr grid,
                                                        const BrickReconstructionOptions& options) {
    requireGrid(grid);
    if (!(options.tolerance >= 1e-6 && options.tolerance <= 0.1)) {
        throw Error(ErrorKind::Usage, "the tolerance of a reconstruction is " +
                                          inShort(options.tolerance) + "; it must be 1e-6 to 0.1");
    }
    return std::make_unique<BrickReconstruction>(
        std::move(grid), designInterpolation(options.filter, options.tolerance), options.mostlyRead,
        options.cacheBytes);
}

std::unique_ptr<Reconstruction> makeSplineReconstruction(
    openvdb::FloatGrid::ConstPtr grid, std::size_t cacheBytes,
    const std::optional<DensityBand>& mostlyRead) {
    requireGrid(grid);
    return std::make_unique<BrickReconstruction>(std::move(grid), splineInterpolation(), mostlyRead,
                                                 cacheBytes);
}

std::unique_ptr<Reconstruction> makeAveragingReconstruction(openvdb::FloatGrid::ConstPtr grid,
                                                            std::size_t cacheBytes) {
    requireGrid(grid);
    return std::make_unique<BrickReconstruction>(std::move(grid), splineAverage(), std::nullopt,
                                                 cacheBytes);
}

}  // namespace bandvox
