#include "reconstruct/brick_cache.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace bandvox {

std::size_t BrickCache::KeyHash::operator()(const Key& key) const {
    std::uint64_t hash = key.isWhole ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ static_cast<std::uint32_t>(key.place[axis])) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    return hash;
}

BrickCache::BrickCache(openvdb::FloatGrid::ConstPtr grid, InterpolationDesign design,
                       const std::optional<DensityBand>& mostlyRead, std::size_t cacheBytes)
    : mGrid(std::move(grid)), mDesign(std::move(design)), mMostlyRead(mostlyRead) {
    const std::size_t bricks = cacheBytes / CoefficientBrick::bytes(mDesign.kernel);
    mBricksPerShard = std::max<std::size_t>(bricks / kShards, 1);
}

std::shared_ptr<BrickCache::Slot> BrickCache::slot(const Key& key) {
    // The low bits choose the bucket inside a shard's table; take others for the shard.
    Shard& shard = mShards[(KeyHash()(key) >> 20) % kShards];
    const std::lock_guard<std::mutex> lock(shard.mutex);
    const auto found = shard.entries.find(key);
    if (found != shard.entries.end()) {
        shard.ages.splice(shard.ages.begin(), shard.ages, found->second.age);
        return found->second.slot;
    }
    if (shard.entries.size() >= mBricksPerShard) {
        shard.entries.erase(shard.ages.back());
        shard.ages.pop_back();
    }
    shard.ages.push_front(key);
    auto slot = std::make_shared<Slot>();
    shard.entries.emplace(key, Entry{slot, shard.ages.begin()});
    return slot;
}

BrickCache::BrickPtr BrickCache::build(const Key& key, BrickScratch& scratch) {
    const std::shared_ptr<Slot> slot = this->slot(key);
    std::call_once(slot->built, [&] {
        slot->brick = std::make_shared<const CoefficientBrick>(
            *mGrid, key.place, mDesign, key.isWhole ? std::nullopt : mMostlyRead, scratch);
    });
    return slot->brick;
}

}  // namespace bandvox
