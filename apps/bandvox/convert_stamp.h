#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox::app {

/// What a file made by `convert` says of how it was made; empty texts if it does not.
struct ConvertStamp {
    std::string settings;  ///< as convert_settings.h has it
    std::string input;     ///< for each file of the input a line "SHA-256 BYTES NAME", the name
                           ///< without its folder; the name alone of a built-in shape; empty of
                           ///< the standard input
};

/// Copies of grids, of the same voxels, that say how they were made: in bandvox_settings and
/// bandvox_input.
openvdb::GridCPtrVec stamped(const openvdb::GridCPtrVec& grids, const ConvertStamp& stamp);

/// The first stamp among grids.
ConvertStamp stampOf(const openvdb::GridPtrVec& grids);

/// The same as notes of a mesh, and back.
std::vector<std::string> toNotes(const ConvertStamp& stamp);
ConvertStamp fromNotes(const std::vector<std::string>& notes);

/// True if convert can say in a file of that name how it was made.
bool holdsStamp(const std::filesystem::path& path);

}  // namespace bandvox::app
