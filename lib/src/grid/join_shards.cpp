#include "grid/constant_leaf.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/join_shards.h>

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <set>
#include <sstream>
#include <string_view>

namespace bandvox {

namespace {

constexpr const char* kShard = "bandvox_shard";
constexpr const char* kOverlaps = "bandvox_shard_overlaps";
constexpr const char* kSettings = "bandvox_settings";
constexpr const char* kRefinements = "bandvox_shard_refinements";

[[noreturn]] void failJoin(const std::string& why) {
    throw Error(ErrorKind::Input, why);
}

std::optional<Shard> parseShard(std::string_view text) {
    Shard shard;
    const char* end = text.data() + text.size();
    const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
    if (error != std::errc() || slash == end || *slash != '/') return std::nullopt;
    const auto [rest, second] = std::from_chars(slash + 1, end, shard.count);
    if (second != std::errc() || rest != end) return std::nullopt;
    constexpr int kMostParts = 100'000;
    if (shard.index < 1 || shard.index > shard.count || shard.count > kMostParts) {
        return std::nullopt;
    }
    return shard;
}

// The settings that convert has stored, a line for each, without that of the part.
std::string wholeSettings(const openvdb::GridBase& grid) {
    const auto text = grid.getMetadata<openvdb::StringMetadata>(kSettings);
    if (!text) return {};
    std::string whole;
    std::istringstream lines(text->value());
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("shard=")) continue;
        if (!whole.empty()) whole += '\n';
        whole += line;
    }
    return whole;
}

// What all parts have to share.
void requireSameKind(const openvdb::GridBase& first, const openvdb::GridBase& other,
                     const std::string& firstName, const std::string& otherName) {
    const auto fail = [&](const std::string& what) {
        failJoin(otherName + " is no part of the grid that " + firstName + " is one of: " + what +
                 " differs");
    };
    if (first.getName() != other.getName()) fail("the name");
    if (first.type() != other.type()) fail("the type");
    if (first.transform() != other.transform()) fail("the lattice");
    for (const char* name : {"bandvox_version", "bandvox_source", "bandvox_order", "bandvox_cutoff",
                             "bandvox_tolerance", "bandvox_route", "bandvox_iso",
                             "bandvox_source_volume", "bandvox_input"}) {
        const auto a = first[name];
        const auto b = other[name];
        if ((a == nullptr) != (b == nullptr) || (a && *a != *b)) fail(name);
    }
    if (wholeSettings(first) != wholeSettings(other)) fail(kSettings);
}

// Adds the values of a part, where it has any, to those of the others, which have none there.
// Blocks that several have a share of are added to `shared`.
template <typename Grid>
void addPart(Grid& whole, Grid& part, std::set<openvdb::Coord>& shared, const Progress& progress) {
    using Tree = typename Grid::TreeType;
    using PartLeaf = typename Tree::LeafNodeType;
    Tree& tree = whole.tree();
    auto tile = part.cbeginValueAll();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (!tile.isValueOn() && *tile == part.background()) continue;
        tree.addTile(tile.getLevel(), tile.getBoundingBox().min(), *tile, tile.isValueOn());
    }
    std::vector<PartLeaf*> stolen;
    part.tree().stealNodes(stolen, part.background(), /*state=*/false);
    std::vector<std::unique_ptr<PartLeaf>> leaves(stolen.begin(), stolen.end());
    for (auto& leaf : leaves) {
        progress.throwIfInterrupted();
        auto* there = tree.probeLeaf(leaf->origin());
        if (!there) {
            tree.addLeaf(leaf.release());
            continue;
        }
        for (auto value = leaf->cbeginValueOn(); value; ++value) {
            there->setValueOn(value.pos(), *value);
        }
        shared.insert(leaf->origin());
    }
}

// Makes tiles of blocks that are whole only now, if all of one is the same whole number.
void makeTiles(openvdb::FloatGrid& grid, const std::set<openvdb::Coord>& shared) {
    for (const openvdb::Coord& origin : shared) {
        const auto* leaf = grid.tree().probeConstLeaf(origin);
        if (!leaf) failJoin("the parts share voxels; expected parts that do not");
        const float first = leaf->getFirstValue();
        if (first != std::nearbyint(first) || !isConstantLeaf(*leaf)) continue;
        grid.tree().addTile(1, origin, first, /*active=*/true);
    }
}

// Limits a density to [0, 1], as where shells overlap.
void limitDensity(openvdb::FloatGrid& grid, const Progress& progress) {
    auto tile = grid.beginValueOn();
    tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        tile.setValue(std::clamp(*tile, 0.0F, 1.0F));
        if (*tile == 0) tile.setActiveState(false);
    }
    for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf) {
        progress.throwIfInterrupted();
        for (auto value = leaf->beginValueOn(); value; ++value) {
            value.setValue(std::clamp(*value, 0.0F, 1.0F));
            if (*value == 0) value.setValueOff();
        }
    }
}

template <typename Grid>
typename Grid::Ptr joinParts(const std::vector<openvdb::GridBase::Ptr>& parts,
                             std::set<openvdb::Coord>& shared, Progress& progress) {
    const auto first = openvdb::gridPtrCast<Grid>(parts.front());
    auto whole = Grid::create(first->background());
    static_cast<openvdb::MetaMap&>(*whole) = static_cast<const openvdb::MetaMap&>(*first);
    for (const char* name : {kShard, kOverlaps, kRefinements}) whole->removeMeta(name);
    forgetPart(*whole);
    whole->setTransform(first->transform().copy());
    for (const auto& part : parts) {
        addPart(*whole, *openvdb::gridPtrCast<Grid>(part), shared, progress);
        progress.advance();
    }
    return whole;
}

// The errors of a whole are the largest of its parts; one that is not known is not known of all.
void joinMetadata(openvdb::FloatGrid& whole, const std::vector<openvdb::GridBase::Ptr>& parts,
                  bool isLimited, Progress& progress) {
    auto metadata = densityMetadata(whole);
    if (!metadata) return;
    const auto larger = [](double a, double b) {
        return std::isnan(a) || std::isnan(b) ? std::nan("") : std::max(a, b);
    };
    for (const auto& part : parts) {
        const auto other = densityMetadata(*part);
        if (!other) continue;
        metadata->closureError = larger(metadata->closureError, other->closureError);
        metadata->samplingError = larger(metadata->samplingError, other->samplingError);
        metadata->storageError = larger(metadata->storageError, other->storageError);
    }
    metadata->clamped = metadata->clamped || isLimited;
    metadata->gridVolume = densityIntegral(whole, progress);
    setDensityMetadata(whole, *metadata);
}

void requireAll(const std::vector<openvdb::GridBase::Ptr>& parts,
                const std::vector<std::string>& names) {
    const int count =
        shardMetadata(*parts.front()) ? shardMetadata(*parts.front())->shard.count : 0;
    std::set<int> found;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto metadata = shardMetadata(*parts[i]);
        if (!metadata) failJoin(names[i] + " is no part of a grid, but a whole one");
        if (metadata->shard.count != count) {
            failJoin(names[i] + " is one of " + std::to_string(metadata->shard.count) +
                     " parts, and " + names.front() + " one of " + std::to_string(count));
        }
        if (!found.insert(metadata->shard.index).second) {
            failJoin(names[i] + " is part " + std::to_string(metadata->shard.index) + " of " +
                     std::to_string(count) + ", which another file is, too");
        }
        requireSameKind(*parts.front(), *parts[i], names.front(), names[i]);
    }
    std::string missing;
    for (int i = 1; i <= count; ++i) {
        if (found.contains(i)) continue;
        if (!missing.empty()) missing += ", ";
        missing += std::to_string(i);
    }
    if (!missing.empty()) {
        failJoin("of " + std::to_string(count) + " parts some are missing: " + missing);
    }
}

}  // namespace

void forgetPart(openvdb::GridBase& grid) {
    if (!grid[kSettings]) return;
    const std::string settings = wholeSettings(grid);
    grid.removeMeta(kSettings);
    grid.insertMeta(kSettings, openvdb::StringMetadata(settings));
}

void setShardMetadata(openvdb::GridBase& grid, const ShardMetadata& metadata) {
    for (const char* name : {kShard, kOverlaps, kRefinements}) grid.removeMeta(name);
    if (metadata.shard.isWhole()) return;
    grid.insertMeta(kShard, openvdb::StringMetadata(std::to_string(metadata.shard.index) + "/" +
                                                    std::to_string(metadata.shard.count)));
    grid.insertMeta(kOverlaps, openvdb::BoolMetadata(metadata.overlaps));
    grid.insertMeta(kRefinements, openvdb::Int32Metadata(metadata.refinements));
}

std::optional<ShardMetadata> shardMetadata(const openvdb::GridBase& grid) {
    const auto text = grid.getMetadata<openvdb::StringMetadata>(kShard);
    if (!text) return std::nullopt;
    const auto shard = parseShard(text->value());
    if (!shard) return std::nullopt;
    ShardMetadata metadata{*shard, false, 0};
    if (const auto overlaps = grid.getMetadata<openvdb::BoolMetadata>(kOverlaps)) {
        metadata.overlaps = overlaps->value();
    }
    if (const auto refinements = grid.getMetadata<openvdb::Int32Metadata>(kRefinements)) {
        metadata.refinements = refinements->value();
    }
    return metadata;
}

JoinedGrid joinShards(const std::vector<openvdb::GridBase::Ptr>& parts,
                      const std::vector<std::string>& names, Progress& progress) {
    if (parts.empty() || names.size() != parts.size()) {
        throw Error(ErrorKind::Usage, "joining needs the parts of a grid, and a name of each");
    }
    requireAll(parts, names);
    bool overlaps = false;
    int least = shardMetadata(*parts.front())->refinements;
    int most = least;
    for (const auto& part : parts) {
        const auto metadata = shardMetadata(*part);
        overlaps = overlaps || metadata->overlaps;
        least = std::min(least, metadata->refinements);
        most = std::max(most, metadata->refinements);
    }

    const ProgressStage stage(progress, "joining", static_cast<std::int64_t>(parts.size()));
    JoinedGrid result;
    std::set<openvdb::Coord> shared;
    if (parts.front()->isType<openvdb::FloatGrid>()) {
        auto grid = joinParts<openvdb::FloatGrid>(parts, shared, progress);
        makeTiles(*grid, shared);
        if (overlaps) limitDensity(*grid, progress);
        openvdb::tools::pruneInactive(grid->tree(), /*threaded=*/false);
        openvdb::tools::pruneTiles(grid->tree(), 0.0F, /*threaded=*/false);
        joinMetadata(*grid, parts, overlaps, progress);
        result.grid = grid;
    } else if (parts.front()->isType<openvdb::Vec3SGrid>()) {
        result.grid = joinParts<openvdb::Vec3SGrid>(parts, shared, progress);
    } else {
        failJoin(names.front() + " holds a grid of " + parts.front()->valueType() +
                 "; parts are joined of floats and of vectors of floats");
    }
    if (overlaps) {
        result.warnings.push_back(
            "parts of the surface overlap or are inside out; the density was limited to [0, 1], "
            "and "
            "its integral is not the volume");
    }
    if (least != most) {
        result.warnings.push_back(
            "some parts needed a finer quadrature than others, so that the whole differs from what "
            "one machine would have made, by less than the tolerance");
    }
    return result;
}

}  // namespace bandvox
