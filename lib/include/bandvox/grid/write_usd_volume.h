#pragma once

#include <openvdb/openvdb.h>

#include <string>

namespace bandvox {

class AtomicFile;

/// Writes a Volume of Universal Scene Description, in text (.usda), that refers to a .vdb file: a
/// field for each grid, an OpenVDBAsset with the grid's name, type and class. Its extent is the box
/// of all active voxels, world units; of those the file says that they are metres and y is up, as
/// the pictures of this library have it. Names of fields are those of the grids, with what no
/// identifier may have replaced by "_"; of several of one name, those after the first get a number.
///
/// `vdb`: the file as seen from the folder of the .usda file, so mostly a name. `half`: its values
/// are stored in 16 bits. The caller commits the file. Throws Error(ErrorKind::Usage) if there is
/// no grid, or the name has a character that ends it; Error(ErrorKind::Result) if no voxel is
/// active, Error(ErrorKind::Runtime) if it cannot be written.
void writeUsdVolume(AtomicFile& file, const std::string& vdb, const openvdb::GridCPtrVec& grids,
                    bool half = false);

}  // namespace bandvox
