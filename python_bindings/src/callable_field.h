#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/field_source.h>

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <span>
#include <string>

namespace bandvox::python {

/// The box of a function: the lowest place and the highest. Throws Error(ErrorKind::Usage) if it is
/// None or something else.
openvdb::BBoxd boundsOfFunction(const pybind11::object& bounds);

/// A density given by a function of Python, f(x, y, z) of three arrays of the same length, world
/// units. It is called from many threads, one at a time, with rows of places. To be made and
/// destroyed with the interpreter's lock.
class CallableField final : public FieldSource {
  public:
    CallableField(pybind11::object function, const openvdb::BBoxd& bounds);

    std::string name() const override { return mName; }
    openvdb::BBoxd bounds() const override { return mBounds; }

    /// Has rows be refused from when that is interrupted; it has to live as long as they are asked
    /// for.
    void watch(const Progress& progress) const { mProgress = &progress; }

    /// Throws Error(ErrorKind::Interrupted) once the function has thrown, or the work is stopped.
    void sampleRow(const openvdb::Vec3d& start, const openvdb::Vec3d& step,
                   std::span<float> values) const override;

    /// Throws what the function threw, if it did. To be called with the lock.
    void rethrow() const;

  private:
    pybind11::object mFunction;
    openvdb::BBoxd mBounds;
    std::string mName;
    mutable std::atomic<bool> mHasFailed{false};
    mutable std::exception_ptr mFailure;
    mutable std::atomic<const Progress*> mProgress{nullptr};
};

}  // namespace bandvox::python
