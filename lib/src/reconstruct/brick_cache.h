#pragma once

#include "reconstruct/coefficient_brick.h"

#include <openvdb/openvdb.h>

#include <array>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>

namespace bandvox {

/// Bricks by place, built when they are first asked for; of too many, those asked for longest ago
/// are forgotten. Safe to use from many threads: each brick has one of a few locks, none of which
/// is held while a brick is built.
class BrickCache {
  public:
    using BrickPtr = std::shared_ptr<const CoefficientBrick>;

    /// `mostlyRead` is as for CoefficientBrick.
    BrickCache(openvdb::FloatGrid::ConstPtr grid, InterpolationDesign design,
               const std::optional<DensityBand>& mostlyRead, std::size_t cacheBytes);

    const SpreadingKernel& kernel() const { return mDesign.kernel; }

    /// The brick at a place in units of bricks, as far as places are mostly read.
    BrickPtr brick(const openvdb::Coord& place, BrickScratch& scratch) {
        return build({place, false}, scratch);
    }
    /// All of it.
    BrickPtr wholeBrick(const openvdb::Coord& place, BrickScratch& scratch) {
        return build({place, true}, scratch);
    }

  private:
    // A brick that is there, or that the first thread to ask for it is building.
    struct Slot {
        std::once_flag built;
        BrickPtr brick;
    };
    struct Key {
        openvdb::Coord place;
        bool isWhole;
        bool operator==(const Key&) const = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const;
    };
    struct Entry {
        std::shared_ptr<Slot> slot;
        std::list<Key>::iterator age;
    };
    struct Shard {
        std::mutex mutex;
        std::unordered_map<Key, Entry, KeyHash> entries;
        std::list<Key> ages;  // asked for most lately first
    };
    static constexpr std::size_t kShards = 16;

    std::shared_ptr<Slot> slot(const Key& key);
    BrickPtr build(const Key& key, BrickScratch& scratch);

    openvdb::FloatGrid::ConstPtr mGrid;
    InterpolationDesign mDesign;
    std::optional<DensityBand> mMostlyRead;
    std::size_t mBricksPerShard;
    std::array<Shard, kShards> mShards;
};

}  // namespace bandvox
