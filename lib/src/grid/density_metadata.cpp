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
    visit("source_volume", metadata.sourceVolume);
    visit("grid_volume", metadata.gridVolume);
    visit("holes_capped", metadata.holesCapped);
    visit("clamped", metadata.clamped);
}

}  // namespace

void setDensityMetadata(openvdb::GridBase& grid, const DensityMetadata& metadata) {
    visitMembers(metadata, [&grid](const char* name, const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        const std::string key = std::string(kPrefix) + name;
        if (grid[key]) grid.removeMeta(key);
        grid.insertMeta(key, openvdb::TypedMetadata<Value>(value));
    });
}

std::optional<DensityMetadata> densityMetadata(const openvdb::GridBase& grid) {
    DensityMetadata metadata;
    bool found = false;
    visitMembers(metadata, [&](const char* name, auto& value) {
        using Value = std::decay_t<decltype(value)>;
        const auto typed =
            grid.getMetadata<openvdb::TypedMetadata<Value>>(std::string(kPrefix) + name);
        if (!typed) return;
        value = typed->value();
        found = true;
    });
    if (!found) return std::nullopt;
    return metadata;
}

}  // namespace bandvox
