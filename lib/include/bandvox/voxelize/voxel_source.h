#pragma once

#include <bandvox/source/field_source.h>

#include <openvdb/openvdb.h>

#include <string>

namespace bandvox {

/// A grid of voxels as a field: each voxel has its value all over its cube, i ± 1/2 in the grid's
/// index space. For a mask, see maskToVoxels.
class VoxelSource final : public FieldSource {
  public:
    /// `grid`: active wherever it is not 0, as meshToVoxels and fieldToVoxels make it; it must not
    /// be changed later. Throws Error(ErrorKind::Input) if its background is not 0, its transform
    /// is not linear, or nothing is active.
    VoxelSource(std::string name, openvdb::FloatGrid::ConstPtr grid);

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    /// Known of boxes that few nodes of the grid make up, whose values are one.
    std::optional<float> constantIn(const openvdb::BBoxd& box) const override;
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

  private:
    std::string mName;
    openvdb::FloatGrid::ConstPtr mGrid;
    openvdb::BBoxd mBounds;
};

}  // namespace bandvox
