#include "core/words.h"
#include "mesh/triangle_tree.h"
#include "render/picture_request.h"
#include "render/surface_field.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/mesh/density_to_level_set.h>
#include <bandvox/mesh/density_to_mesh.h>

#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

using openvdb::Vec3d;

namespace {

using BandLeaf = openvdb::FloatTree::LeafNodeType;
constexpr int kBandSide = BandLeaf::DIM;
constexpr int kBlocksTogether = 16;
constexpr int kMostFootSteps = 8;
constexpr std::size_t kBandCacheBytes = std::size_t(256) << 20;

// What the foot may be nearer or farther than the mesh, voxels, before it counts as another one.
constexpr double kLargestCorrection = 0.25;

// Of what is allowed, the part that reading between nodes may take, as density.
constexpr double kReadingShare = 0.05;

Mesh inIndexSpace(Mesh mesh, const openvdb::FloatGrid& grid) {
    for (Vec3d& point : mesh.points) point = grid.worldToIndex(point);
    return mesh;
}

/// A surface and how near to it a place has to be.
struct FootSearch {
    double iso;
    double tolerance;  // voxels
};

// How far `place` is from the surface, voxels: from the foot of its perpendicular, which is sought
// from `start`; `fallback` if it is not found.
double distanceToFoot(DensityProbe& probe, const FootSearch& search, const Vec3d& place,
                      const Vec3d& start) {
    const double fallback = (place - start).length();
    Vec3d foot = start;
    for (int step = 0; step < kMostFootSteps; ++step) {
        const DensityAt at = probe.evaluate(foot);
        const double slope = at.gradient.lengthSqr();
        if (!(slope > 0)) return fallback;
        const Vec3d ahead = (search.iso - at.value) / slope * at.gradient;
        foot += ahead;
        const Vec3d away = place - foot;
        const Vec3d along = away - away.dot(at.gradient) / slope * at.gradient;
        // A foot that is off by some way along the surface changes the distance by its square.
        const double distance = away.length();
        const bool isOn = ahead.length() <= 0.5 * search.tolerance;
        if (isOn && along.lengthSqr() <= search.tolerance * std::max(distance, search.tolerance)) {
            return std::abs(distance - fallback) <= kLargestCorrection ? distance : fallback;
        }
        foot += along;
        if ((foot - start).lengthSqr() > 1) return fallback;
    }
    return fallback;
}

void requireCubes(const openvdb::FloatGrid& grid) {
    if (grid.hasUniformVoxels()) return;
    const Vec3d size = grid.voxelSize();
    throw Error(ErrorKind::Input, "the voxels of the grid \"" + grid.getName() + "\" are " +
                                      inShort(size[0]) + " x " + inShort(size[1]) + " x " +
                                      inShort(size[2]) +
                                      " world units; a level set needs cubes, which resampling to "
                                      "one voxel size makes of them");
}

// The blocks of 8³ voxels that may have one as near to the mesh as `halfWidth`, voxels; each once.
std::vector<openvdb::Coord> blocksAround(const Mesh& mesh, double halfWidth) {
    openvdb::MaskTree touched;
    {
        openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(touched);
        for (const Vec3d& point : mesh.points) accessor.touchLeaf(openvdb::Coord::floor(point));
    }
    // A triangle is in one cell, so that its points are in or beside the block that it is in.
    const int reach = 1 + static_cast<int>(halfWidth) / kBandSide;
    openvdb::MaskTree around;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(around);
    for (auto leaf = touched.cbeginLeaf(); leaf; ++leaf) {
        for (int x = -reach; x <= reach; ++x) {
            for (int y = -reach; y <= reach; ++y) {
                for (int z = -reach; z <= reach; ++z) {
                    accessor.touchLeaf(
                        leaf->origin().offsetBy(x * kBandSide, y * kBandSide, z * kBandSide));
                }
            }
        }
    }
    std::vector<openvdb::Coord> blocks;
    for (auto leaf = around.cbeginLeaf(); leaf; ++leaf) blocks.push_back(leaf->origin());
    return blocks;
}

/// Makes the blocks of the band, for one thread.
class BandFill {
  public:
    BandFill(const DrawableGrid& drawable, const Reconstruction& reconstruction,
             const TriangleTree& surface, const LevelSetOptions& options)
        : mDrawable(drawable),
          mDensity(drawable.grid->getConstAccessor()),
          mProbe(reconstruction.probe()),
          mSurface(surface),
          mSearch{drawable.iso, options.tolerance},
          mHalfWidth(options.halfWidth),
          mVoxel(drawable.grid->voxelSize()[0]) {}

    /// The block at `origin`; null if no voxel of it is in the band.
    std::unique_ptr<BandLeaf> makeLeaf(const openvdb::Coord& origin) {
        mLeaf = std::make_unique<BandLeaf>(origin, 0.0F);
        fill(origin, kBandSide, {});
        if (mLeaf->isEmpty()) return nullptr;
        return std::move(mLeaf);
    }

    double largestCorrection() const { return mLargestCorrection; }

  private:
    // A cube of voxels: none of it is in the band if the middle is too far away, else its eighths.
    void fill(const openvdb::Coord& low, int side, std::optional<std::uint32_t> guess) {
        if (side == 1) return fillVoxel(low, guess);
        const double half = 0.5 * (side - 1);
        const Vec3d middle = low.asVec3d() + Vec3d(half);
        const auto nearest = mSurface.nearestWithin(
            middle, mHalfWidth + kLargestCorrection + std::sqrt(3.0) * half, guess);
        if (!nearest) return fillOutside(low, side);
        for (int i = 0; i < 8; ++i) {
            const openvdb::Coord part(i & 1, i >> 1 & 1, i >> 2);
            fill(low + openvdb::Coord(part[0] * side / 2, part[1] * side / 2, part[2] * side / 2),
                 side / 2, nearest->triangle);
        }
    }

    void fillOutside(const openvdb::Coord& low, int side) {
        for (int x = 0; x < side; ++x) {
            for (int y = 0; y < side; ++y) {
                for (int z = 0; z < side; ++z) setOutside(low.offsetBy(x, y, z));
            }
        }
    }

    void setOutside(const openvdb::Coord& at) {
        mLeaf->setValueOff(at, static_cast<float>(sign(at) * mHalfWidth * mVoxel));
    }

    void fillVoxel(const openvdb::Coord& at, std::optional<std::uint32_t> guess) {
        const Vec3d place = at.asVec3d();
        const auto nearest = mSurface.nearestWithin(place, mHalfWidth + kLargestCorrection, guess);
        if (!nearest) return setOutside(at);
        const double toMesh = std::sqrt(nearest->square);
        const double distance = distanceToFoot(*mProbe, mSearch, place, nearest->point);
        if (distance >= mHalfWidth) return setOutside(at);
        mLargestCorrection = std::max(mLargestCorrection, std::abs(distance - toMesh));
        mLeaf->setValueOn(at, static_cast<float>(sign(at) * distance * mVoxel));
    }

    int sign(const openvdb::Coord& at) { return mDensity.getValue(at) > mDrawable.iso ? -1 : 1; }

    const DrawableGrid& mDrawable;
    openvdb::FloatGrid::ConstAccessor mDensity;
    std::unique_ptr<DensityProbe> mProbe;
    const TriangleTree& mSurface;
    FootSearch mSearch;
    double mHalfWidth, mVoxel;
    std::unique_ptr<BandLeaf> mLeaf;
    double mLargestCorrection = 0;
};

// Adds the band to a tree. Returns the largest correction, voxels.
double addBand(const DrawableGrid& drawable, const TriangleTree& surface,
               const LevelSetOptions& options, openvdb::FloatTree& tree, Progress& progress) {
    PictureOptions reading;
    reading.tolerance = std::max(kReadingShare * options.tolerance, 1e-6);
    reading.cacheBytes = kBandCacheBytes;
    const auto reconstruction = readLattice(drawable.grid, drawable.metadata, reading);
    const std::vector<openvdb::Coord> blocks = blocksAround(surface.mesh(), options.halfWidth);
    const auto count = static_cast<std::int64_t>(blocks.size());
    const std::int64_t tasks = (count + kBlocksTogether - 1) / kBlocksTogether;
    std::vector<std::unique_ptr<BandLeaf>> leaves(blocks.size());
    std::vector<double> corrections(static_cast<std::size_t>(tasks), 0);
    {
        const ProgressStage stage(progress, "distances", tasks);
        parallelFor(tasks, [&](std::int64_t task) {
            progress.throwIfInterrupted();
            BandFill fill(drawable, *reconstruction, surface, options);
            const std::int64_t begin = task * kBlocksTogether;
            for (std::int64_t i = begin; i < std::min(begin + kBlocksTogether, count); ++i) {
                leaves[static_cast<std::size_t>(i)] =
                    fill.makeLeaf(blocks[static_cast<std::size_t>(i)]);
            }
            corrections[static_cast<std::size_t>(task)] = fill.largestCorrection();
            progress.advance();
        });
    }
    for (auto& leaf : leaves) {
        if (leaf) tree.addLeaf(leaf.release());
    }
    return tasks == 0 ? 0 : *std::max_element(corrections.begin(), corrections.end());
}

}  // namespace

LevelSetResult densityToLevelSet(const openvdb::FloatGrid::ConstPtr& grid,
                                 const LevelSetOptions& options, Progress& progress) {
    if (!(options.halfWidth >= 1 && options.halfWidth <= 100)) {
        throw Error(ErrorKind::Usage, "the level set's half width is " +
                                          inShort(options.halfWidth) +
                                          " voxels; it must be 1 to 100");
    }
    MeshOptions meshOptions;
    meshOptions.iso = options.iso;
    meshOptions.tolerance = options.tolerance;
    MeshResult surface = densityToMesh(grid, meshOptions, progress);
    requireCubes(*grid);

    const Mesh mesh = inIndexSpace(std::move(surface.surface.mesh), *grid);
    const TriangleTree tree(mesh);
    LevelSetResult result;
    result.iso = surface.iso;
    result.volume = surface.volume;
    const double background = options.halfWidth * grid->voxelSize()[0];
    result.grid = openvdb::FloatGrid::create(static_cast<float>(background));
    result.grid->setTransform(grid->transform().copy());
    result.largestCorrection =
        addBand(makeDrawable(grid, options.iso), tree, options, result.grid->tree(), progress);
    openvdb::tools::signedFloodFill(result.grid->tree());
    result.grid->setName("surface");
    result.grid->setGridClass(openvdb::GRID_LEVEL_SET);
    setSourceMetadata(*result.grid, sourceOf(*grid));
    setPlaceMetadata(*result.grid, placeMetadata(*grid));
    return result;
}

openvdb::FloatGrid::Ptr levelSetToFog(const openvdb::FloatGrid::Ptr& levelSet) {
    openvdb::tools::sdfToFogVolume(*levelSet);
    levelSet->setName("density");
    return levelSet;
}

}  // namespace bandvox
