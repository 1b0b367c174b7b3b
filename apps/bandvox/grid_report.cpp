#include "grid_report.h"

#include "option_values.h"
#include "report_words.h"
#include "words.h"

#include <nlohmann/json.hpp>

#include <string_view>

namespace bandvox::app {
namespace {

using Json = nlohmann::ordered_json;

using app::toJson;

constexpr std::string_view kOwnPrefix = "bandvox_";

/// True for metadata that say again what the report says under another key.
bool isReportedElsewhere(const std::string& name) {
    using openvdb::GridBase;
    return name == GridBase::META_GRID_NAME || name == GridBase::META_GRID_CLASS ||
           name == GridBase::META_SAVE_HALF_FLOAT;
}

Json toJson(const openvdb::Coord& coord) {
    return Json::array({coord.x(), coord.y(), coord.z()});
}

/// A metadata value as the JSON type that is nearest, text for those without one.
Json toJson(const openvdb::Metadata& metadata) {
    if (const auto* m = dynamic_cast<const openvdb::BoolMetadata*>(&metadata)) return m->value();
    if (const auto* m = dynamic_cast<const openvdb::Int32Metadata*>(&metadata)) return m->value();
    if (const auto* m = dynamic_cast<const openvdb::Int64Metadata*>(&metadata)) return m->value();
    if (const auto* m = dynamic_cast<const openvdb::FloatMetadata*>(&metadata)) return m->value();
    if (const auto* m = dynamic_cast<const openvdb::DoubleMetadata*>(&metadata)) return m->value();
    if (const auto* m = dynamic_cast<const openvdb::Vec3IMetadata*>(&metadata)) {
        return Json::array({m->value().x(), m->value().y(), m->value().z()});
    }
    if (const auto* m = dynamic_cast<const openvdb::Vec3SMetadata*>(&metadata)) {
        return toJson(openvdb::Vec3d(m->value()));
    }
    if (const auto* m = dynamic_cast<const openvdb::Vec3DMetadata*>(&metadata)) {
        return toJson(m->value());
    }
    return metadata.str();
}

void appendBlock(std::string& out, const std::string& name, const Json& values) {
    if (values.empty()) return;
    out += "  " + name + '\n';
    for (const auto& [key, value] : values.items()) {
        out += "    " + printable(key) + ":";
        const bool hasLines = value.is_string() &&
                              value.get_ref<const std::string&>().find('\n') != std::string::npos;
        if (!hasLines) {
            out += ' ' + inWords(value) + '\n';
            continue;
        }
        out += '\n';
        for (const std::string_view line : split(value.get_ref<const std::string&>(), '\n')) {
            out += "      " + printable(std::string(line)) + '\n';
        }
    }
}

std::string gridInWords(const Json& grid) {
    std::string out = "\ngrid '" + inWords(grid["name"]) + "'\n";
    appendLine(out, "class", inWords(grid["class"]));
    appendLine(
        out, "values",
        inWords(grid["value_type"]) + (grid["half"].get<bool>() ? ", stored with 16 bits" : ""));
    appendLine(out, "voxel size", inWords(grid["voxel_size"]));
    appendLine(out, "index box", boundsInWords(grid["index_bounds"]));
    appendLine(out, "world box", boundsInWords(grid["world_bounds"]));
    appendLine(out, "active voxels", inWords(grid["active_voxels"]));
    appendLine(out, "active tiles", inWords(grid["active_tiles"]));
    appendLine(out, "memory", formatBytes(grid["memory_bytes"].get<std::int64_t>()));
    if (grid.contains("compression")) appendLine(out, "compression", inWords(grid["compression"]));
    if (grid.contains("bandvox")) appendBlock(out, "bandvox", grid["bandvox"]);
    appendBlock(out, "metadata", grid["metadata"]);
    return out;
}

}  // namespace

nlohmann::ordered_json gridReport(const openvdb::GridBase& grid) {
    Json report;
    report["name"] = grid.getName();
    report["type"] = grid.type();
    report["class"] = openvdb::GridBase::gridClassToString(grid.getGridClass());
    report["value_type"] = grid.valueType();
    report["voxel_size"] = toJson(grid.voxelSize());

    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty()) {
        report["index_bounds"] = nullptr;
        report["world_bounds"] = nullptr;
    } else {
        // Voxel centres lie at whole indices.
        const openvdb::Vec3d half(0.5);
        const openvdb::BBoxd world = grid.transform().indexToWorld(
            openvdb::BBoxd(box.min().asVec3d() - half, box.max().asVec3d() + half));
        report["index_bounds"] = {{"min", toJson(box.min())}, {"max", toJson(box.max())}};
        report["world_bounds"] = {{"min", toJson(world.min())}, {"max", toJson(world.max())}};
    }
    report["active_voxels"] = grid.activeVoxelCount();
    report["active_tiles"] = grid.constBaseTree().activeTileCount();
    report["memory_bytes"] = grid.memUsage();

    Json own = Json::object();
    Json others = Json::object();
    for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
        const std::string& name = entry->first;
        if (!entry->second) continue;
        if (name == openvdb::GridBase::META_FILE_COMPRESSION) {
            report["compression"] = toJson(*entry->second);
        } else if (name.starts_with(kOwnPrefix)) {
            own[name.substr(kOwnPrefix.size())] = toJson(*entry->second);
        } else if (!isReportedElsewhere(name)) {
            others[name] = toJson(*entry->second);
        }
    }
    report["half"] = grid.saveFloatAsHalf();
    if (!own.empty()) report["bandvox"] = own;
    report["metadata"] = others;
    return report;
}

std::string reportInWords(const nlohmann::ordered_json& report) {
    const std::size_t count = report["grids"].size();
    const Json& bytes = report["file_bytes"];
    std::string out = inWords(report["file"]) + ": " +
                      (bytes.is_null() ? "" : formatBytes(bytes.get<std::int64_t>()) + ", ") +
                      formatCount(static_cast<std::int64_t>(count), "grid", "grids") + '\n';
    for (const Json& grid : report["grids"]) out += gridInWords(grid);
    return out;
}

}  // namespace bandvox::app
