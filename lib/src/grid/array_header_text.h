#pragma once

#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/write_array.h>

#include <string>

namespace bandvox {

/// What the header of an array says.
struct ArrayHeaderRequest {
    openvdb::Coord size;
    VoxelType type = VoxelType::Float;
    openvdb::Mat4d toWorld;  ///< from the index in the array, acting on rows
    PlaceMetadata place;
    bool compressed = false;
    std::string valuesFile;  ///< its name; empty if the values follow
};

/// Throw Error(ErrorKind::Usage) if the format cannot hold the type.
std::string npyHeader(const ArrayHeaderRequest& request);
std::string nrrdHeader(const ArrayHeaderRequest& request);
std::string metaImageHeader(const ArrayHeaderRequest& request);

}  // namespace bandvox
