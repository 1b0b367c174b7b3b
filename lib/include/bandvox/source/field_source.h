#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>

#include <optional>
#include <span>
#include <string>

namespace bandvox {

/// A density given by its values: 1 inside, 0 outside, or any field. It is asked for one row of
/// points at a time and never sampled as a whole.
///
/// An object is immutable once built, and may be read by many threads.
class FieldSource {
  public:
    virtual ~FieldSource() = default;

    /// What it was made from: a file's name, or "shape:torus".
    virtual std::string name() const = 0;

    /// A box outside which the field is 0, world units. Of values outside it nobody takes any
    /// notice; its faces count in.
    virtual openvdb::BBoxd bounds() const = 0;

    /// The value that the field has everywhere in `box` (world units), if that is cheap to know. It
    /// may say nothing of a box in which the field is constant, but is never wrong.
    virtual std::optional<float> constantIn(const openvdb::BBoxd& /*box*/) const {
        return std::nullopt;
    }

    /// Sets values[i] to the field at `start + i·step`, world units.
    virtual void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                           std::span<float> values) const = 0;
};

}  // namespace bandvox
