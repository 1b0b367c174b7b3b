#pragma once

#include "reconstruct/coefficient_brick.h"

#include <openvdb/openvdb.h>

#include <array>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace bandvox {

/// Bricks by place, built when they are first asked for; of too many, those asked for longest ago
/// are forgotten. Safe to use from many threads: each brick has one of a few locks, none of which
/// is held while a brick is built.
class BrickCache {
  public:
    using BrickPtr = std::shared_ptr<const CoefficientBrick>;

    BrickCache(openvdb::FloatGrid::ConstPtr grid, InterpolationDesign design,
               std::size_t cacheBytes);

    const SpreadingKernel& kernel() const { return mDesign.kernel; }

    /// The brick at a place in units of bricks.
    BrickPtr brick(const openvdb::Coord& place, BrickScratch& scratch);

  private:
    // A brick that is there, or that the first thread to ask for it is building.
    struct Slot {
        std::once_flag built;
        BrickPtr brick;
    };
    struct Entry {
        std::shared_ptr<Slot> slot;
        std::list<openvdb::Coord>::iterator age;
    };
    struct PlaceHash {
        std::size_t operator()(const openvdb::Coord& place) const;
    };
    struct Shard {
        std::mutex mutex;
        std::unordered_map<openvdb::Coord, Entry, PlaceHash> entries;
        std::list<openvdb::Coord> ages;  // asked for most lately first
    };
    static constexpr std::size_t kShards = 16;

    std::shared_ptr<Slot> slot(const openvdb::Coord& place);

    openvdb::FloatGrid::ConstPtr mGrid;
    InterpolationDesign mDesign;
    std::size_t mBricksPerShard;
    std::array<Shard, kShards> mShards;
};

}  // namespace bandvox
