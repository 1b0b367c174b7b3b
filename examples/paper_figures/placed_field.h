#pragma once

#include <bandvox/source/field_source.h>

#include <openvdb/Types.h>

#include <memory>
#include <vector>

namespace paper_figures {

using FieldPtr = std::shared_ptr<const bandvox::FieldSource>;

/// Where a shape is put: turned, scaled, then moved.
struct Placement {
    openvdb::Mat3d turn = openvdb::Mat3d::identity();  ///< a rotation
    double scale = 1;                                  ///< > 0
    openvdb::Vec3d move{0, 0, 0};                      ///< world units

    openvdb::Vec3d toWorld(const openvdb::Vec3d& shape) const {
        return scale * (turn * shape) + move;
    }
    openvdb::Vec3d toShape(const openvdb::Vec3d& world) const {
        return turn.transpose() * (world - move) / scale;
    }
};

/// A placement that is turned about y by `azimuth` and then about x by `tilt`, degrees.
Placement turned(double azimuth, double tilt, double scale,
                 const openvdb::Vec3d& move = openvdb::Vec3d(0.0));

/// A field, placed.
class PlacedField final : public bandvox::FieldSource {
  public:
    PlacedField(FieldPtr field, const Placement& placement);

    std::string name() const override { return mField->name(); }
    openvdb::BBoxd bounds() const override { return mBounds; }
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

  private:
    FieldPtr mField;
    Placement mPlacement;
    openvdb::BBoxd mBounds;
};

/// The union of solids: the largest of their values.
class UnionField final : public bandvox::FieldSource {
  public:
    explicit UnionField(std::vector<FieldPtr> fields);

    std::string name() const override { return mFields.front()->name(); }
    openvdb::BBoxd bounds() const override { return mBounds; }
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

  private:
    std::vector<FieldPtr> mFields;
    openvdb::BBoxd mBounds;
};

}  // namespace paper_figures
