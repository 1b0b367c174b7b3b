#pragma once

#include <openvdb/Types.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace bandvox::python {

/// What a call says, by the names of the command's options, as the package's own modules hand it
/// on. Values of the wrong kind are Error(ErrorKind::Usage), which names them.
class Settings {
  public:
    explicit Settings(pybind11::dict values) : mValues(std::move(values)) {}

    bool isGiven(const char* name) const { return !at(name).is_none(); }
    pybind11::object at(const char* name) const;

    bool flag(const char* name) const { return read<bool>(name, "True or False"); }
    int wholeNumber(const char* name) const { return read<int>(name, "a whole number"); }
    double number(const char* name) const { return read<double>(name, "a number"); }
    std::string word(const char* name) const { return read<std::string>(name, "text"); }
    openvdb::Vec3d vector(const char* name) const;
    std::optional<openvdb::Vec3d> optionalVector(const char* name) const;

  private:
    [[noreturn]] void fail(const char* name, const char* expected) const;

    template <typename Value>
    Value read(const char* name, const char* expected) const {
        try {
            return at(name).cast<Value>();
        } catch (const pybind11::cast_error&) {
            fail(name, expected);
        }
    }

    pybind11::dict mValues;
};

}  // namespace bandvox::python
