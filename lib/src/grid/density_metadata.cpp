#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/Metadata.h>

namespace bandvox {

namespace {

constexpr const char* kPrefix = "bandvox_";

// Visits every member with its name, so that writing and reading cannot disagree.
template <typename Metadata, typename Visitor>
void visitMembers(Metadata& metadata, const Visitor& visit) {
    visit("version", metadata.version);
    visit("source", metadata.source);
    visit("route", metadata.route);
    visit("order", metadata.order);
    visit("cutoff", metadata.cutoff);
    visit("oversampling", metadata.oversampling);
    visit("iso", metadata.iso);
    visit("tolerance", metadata.tolerance);
    visit("closure_error", metadata.closureError);
    visit("sampling_error", metadata.samplingError);
    visit("storage_error", metadata.storageError);
    visit("source_volume", metadata.sourceVolume);
    visit("grid_volume", metadata.gridVolume);
    visit("holes_capped", metadata.holesCapped);
    visit("clamped", metadata.clamped);
}

template <typename Value>
void setMember(openvdb::GridBase& grid, const char* name, const Value& value) {
    const std::string key = std::string(kPrefix) + name;
    if (grid[key]) grid.removeMeta(key);
    grid.insertMeta(key, openvdb::TypedMetadata<Value>(value));
}

std::string textOf(const openvdb::GridBase& grid, const char* name) {
    const auto text = grid.getMetadata<openvdb::StringMetadata>(std::string(kPrefix) + name);
    return text ? text->value() : std::string();
}

}  // namespace

void setDensityMetadata(openvdb::GridBase& grid, const DensityMetadata& metadata) {
    visitMembers(metadata,
                 [&grid](const char* name, const auto& value) { setMember(grid, name, value); });
}

void setSourceMetadata(openvdb::GridBase& grid, const std::string& source) {
    setMember(grid, "version", std::string(version()));
    setMember(grid, "source", source);
}

void setVoxelMetadata(openvdb::GridBase& grid, const std::string& source) {
    setSourceMetadata(grid, source);
    setMember(grid, "iso", 0.5);
}

std::string sourceOf(const openvdb::GridBase& grid) {
    return textOf(grid, "source");
}

std::optional<DensityMetadata> densityMetadata(const openvdb::GridBase& grid) {
    // Without its filter a density cannot be read as a band-limited one.
    for (const char* needed : {"order", "cutoff"}) {
        if (!grid[std::string(kPrefix) + needed]) return std::nullopt;
    }
    DensityMetadata metadata;
    visitMembers(metadata, [&](const char* name, auto& value) {
        using Value = std::decay_t<decltype(value)>;
        const auto typed =
            grid.getMetadata<openvdb::TypedMetadata<Value>>(std::string(kPrefix) + name);
        if (typed) value = typed->value();
    });
    return metadata;
}

bool isDensityOfSolid(const openvdb::GridBase& grid) {
    const auto metadata = densityMetadata(grid);
    return metadata && metadata->route != "filtered";
}

PlaceMetadata placeMetadata(const openvdb::GridBase& grid) {
    return {textOf(grid, "unit"), textOf(grid, "space")};
}

void setPlaceMetadata(openvdb::GridBase& grid, const PlaceMetadata& place) {
    if (!place.unit.empty()) setMember(grid, "unit", place.unit);
    if (!place.space.empty()) setMember(grid, "space", place.space);
}

}  // namespace bandvox
