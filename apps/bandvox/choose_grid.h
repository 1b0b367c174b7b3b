#pragma once

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

// Grids of a file by name. NAME[1] is the second one of that name. Errors are of the kind
// ErrorKind::Input, and list what `file` holds.
namespace bandvox::app {

/// The grid of this name, of any type.
openvdb::GridBase::Ptr chooseGrid(const openvdb::GridPtrVec& grids, const std::string& name,
                                  const std::string& file);

/// The grid, or one of its numbers or truths as floats; null if it has neither.
openvdb::FloatGrid::Ptr asFloatGrid(const openvdb::GridBase::Ptr& grid);

/// The grid of floats that is asked for; without a name that of the standard name, else the only
/// one of floats. Doubles are turned into floats.
openvdb::FloatGrid::Ptr chooseFloatGrid(const openvdb::GridPtrVec& grids,
                                        const std::optional<std::string>& name,
                                        const std::string& standard, const std::string& file);

/// The same, or null if there is none of the standard name.
openvdb::FloatGrid::Ptr findFloatGrid(const openvdb::GridPtrVec& grids,
                                      const std::optional<std::string>& name,
                                      const std::string& standard, const std::string& file);

/// The grid of vectors of floats that is asked for; without a name that named Cd, or null.
openvdb::Vec3SGrid::Ptr chooseColorGrid(const openvdb::GridPtrVec& grids,
                                        const std::optional<std::string>& name,
                                        const std::string& file);

}  // namespace bandvox::app
