#pragma once

#include <bandvox/source/boundary_source.h>
#include <bandvox/source/field_source.h>
#include <bandvox/source/mesh_source.h>

#include <openvdb/openvdb.h>

#include <memory>
#include <utility>
#include <vector>

namespace bandvox::experiments {

/// A box with half sides `half`, turned by `rotation` about its centre; world units.
struct Box {
    openvdb::Vec3d half;
    openvdb::Vec3d center{0, 0, 0};
    openvdb::Mat3R rotation = openvdb::Mat3R::identity();

    MeshSource boundary() const;
    double volume() const { return 8 * half.x() * half.y() * half.z(); }
};

/// The same solid by its values: 1 inside and on its faces, 0 outside.
class BoxField final : public FieldSource {
  public:
    explicit BoxField(const Box& box);
    std::string name() const override { return "box"; }
    openvdb::BBoxd bounds() const override { return mBounds; }
    std::optional<float> constantIn(const openvdb::BBoxd& box) const override;
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

  private:
    openvdb::Vec3d toLocal(const openvdb::Vec3d& vector) const { return mBack * vector; }

    Box mBox;
    openvdb::Mat3R mBack;  // from the world's axes to the box's
    openvdb::BBoxd mBounds;
};

/// A solid of which samples that lie on a face count ½: the mean of the values just before and
/// just behind every place. Refers to a field that outlives it.
class HalfOnFaces final : public FieldSource {
  public:
    explicit HalfOnFaces(const FieldSource& field) : mField(field) {}
    std::string name() const override { return mField.name(); }
    openvdb::BBoxd bounds() const override { return mField.bounds(); }
    std::optional<float> constantIn(const openvdb::BBoxd& box) const override;
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

  private:
    const FieldSource& mField;
};

/// A field moved by `shift`, world units. Refers to a field that outlives it.
class ShiftedField final : public FieldSource {
  public:
    ShiftedField(const FieldSource& field, const openvdb::Vec3d& shift)
        : mField(field), mShift(shift) {}
    std::string name() const override { return mField.name(); }
    openvdb::BBoxd bounds() const override {
        return {mField.bounds().min() + mShift, mField.bounds().max() + mShift};
    }
    std::optional<float> constantIn(const openvdb::BBoxd& box) const override {
        return mField.constantIn({box.min() - mShift, box.max() - mShift});
    }
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override {
        mField.sampleRow(start - mShift, step, values);
    }

  private:
    const FieldSource& mField;
    openvdb::Vec3d mShift;
};

/// Copies of one solid, each shifted. Refers to a source that outlives it.
class ShiftedCopies final : public BoundarySource {
  public:
    /// `shifts`: world units, one for each copy.
    ShiftedCopies(const BoundarySource& source, std::vector<openvdb::Vec3d> shifts)
        : mSource(source), mShifts(std::move(shifts)) {}
    std::string name() const override { return mSource.name(); }
    openvdb::BBoxd bounds() const override;
    double volume() const override { return mSource.volume() * double(mShifts.size()); }
    double area() const override { return mSource.area() * double(mShifts.size()); }
    std::size_t elementCount() const override { return mSource.elementCount() * mShifts.size(); }
    openvdb::BBoxd elementBounds(std::size_t i) const override;
    void sampleElement(std::size_t i, const SamplingRegion& region,
                       const SurfaceQuadrature& quadrature,
                       std::vector<SurfaceSample>& samples) const override;

  private:
    const BoundarySource& mSource;
    std::vector<openvdb::Vec3d> mShifts;
};

}  // namespace bandvox::experiments
