#pragma once

#include <nlohmann/json_fwd.hpp>
#include <openvdb/openvdb.h>

#include <string>

namespace bandvox::app {

/// All that can be told of a grid of any type.
///
/// Keys: name, type, class, value_type, voxel_size (3 numbers), index_bounds and world_bounds
/// (each null if nothing is active, else {min, max}; the world box holds the voxels whole),
/// active_voxels, active_tiles, memory_bytes, compression (absent if not known), half (stored
/// with 16 bits), bandvox (its own metadata without their prefix; absent if there are none) and
/// metadata (all others).
nlohmann::ordered_json gridReport(const openvdb::GridBase& grid);

/// The report of a file {file, file_bytes (null if it has no size), grids: [gridReport...]} for
/// people, with control characters in names and texts written out.
std::string reportInWords(const nlohmann::ordered_json& report);

}  // namespace bandvox::app
