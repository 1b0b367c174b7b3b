#pragma once

#include <bandvox/source/point_cloud.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bandvox {

/// What is read of a point: x y z, nx ny nz, radius.
constexpr std::size_t kPointValues = 7;
constexpr std::size_t kNormalValue = 3;
constexpr std::size_t kRadiusValue = 6;

constexpr std::array<const char*, kPointValues> kPointValueNames{"x",  "y",  "z",     "nx",
                                                                 "ny", "nz", "radius"};

/// Which columns of a table, or properties of a .ply file, are what.
struct PointColumns {
    std::array<std::optional<std::size_t>, kPointValues> column;
    double radiusFactor = 1;  ///< of what is in the file
    bool isNamed = true;      ///< false: by the number of columns alone

    bool hasNormals() const { return column[kNormalValue].has_value(); }
    bool hasRadii() const { return column[kRadiusValue].has_value(); }
};

/// Finds columns by their names. Calls `fail(what)`, which throws, if one of x, y and z or some of
/// a normal are missing, or two columns are the same.
template <typename Fail>
PointColumns columnsByName(const std::vector<std::string>& names, const Fail& fail);

/// True if x, y and z are among the names.
bool namePoints(const std::vector<std::string>& names);

/// Which value of a point a name stands for, and the factor to it; nothing if it is none.
struct NamedValue {
    std::size_t value = 0;
    double factor = 1;
};
std::optional<NamedValue> pointValueOfName(std::string_view name);

/// Takes points one after another.
class PointCloudBuilder {
  public:
    PointCloudBuilder(const PointColumns& columns, std::size_t expected) : mColumns(columns) {
        mCloud.points.reserve(expected);
        if (columns.hasNormals()) mCloud.normals.reserve(expected);
        if (columns.hasRadii()) mCloud.radii.reserve(expected);
    }

    /// `values`: of those that there are. Calls `fail(what)`, which throws, for such as cannot be.
    template <typename Fail>
    void add(const std::array<double, kPointValues>& values, const Fail& fail) {
        for (std::size_t i = 0; i < kPointValues; ++i) {
            if (!mColumns.column[i]) continue;
            if (!(std::abs(values[i]) <= std::numeric_limits<float>::max())) {
                fail("has " + shown(values[i]) + " as " + kPointValueNames[i] +
                     "; expected a finite number");
            }
        }
        mCloud.points.emplace_back(values[0], values[1], values[2]);
        if (mColumns.hasNormals()) addNormal(values, fail);
        if (!mColumns.hasRadii()) return;
        if (values[kRadiusValue] < 0) {
            fail("has the radius " + shown(values[kRadiusValue]) + "; expected 0 or more");
        }
        mCloud.radii.push_back(mColumns.radiusFactor * values[kRadiusValue]);
    }

    PointCloud take() { return std::move(mCloud); }

  private:
    static std::string shown(double value);

    template <typename Fail>
    void addNormal(const std::array<double, kPointValues>& values, const Fail& fail) {
        const openvdb::Vec3d normal(values[kNormalValue], values[kNormalValue + 1],
                                    values[kNormalValue + 2]);
        constexpr double kLongest = 2;
        if (!mColumns.isNamed && normal.length() > kLongest) {
            fail("has a normal of length " + shown(normal.length()) +
                 "; expected about 1, or a first line that names the columns");
        }
        mCloud.normals.emplace_back(normal);
    }

    PointColumns mColumns;
    PointCloud mCloud;
};

template <typename Fail>
PointColumns columnsByName(const std::vector<std::string>& names, const Fail& fail) {
    PointColumns columns;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto named = pointValueOfName(names[i]);
        if (!named) continue;
        auto& column = columns.column[named->value];
        if (column) {
            fail("has both '" + names[*column] + "' and '" + names[i] + "'; expected one of them");
        }
        column = i;
        if (named->value == kRadiusValue) columns.radiusFactor = named->factor;
    }
    for (std::size_t i = 0; i < kRadiusValue; ++i) {
        const bool isNeeded =
            i < kNormalValue || columns.column[3] || columns.column[4] || columns.column[5];
        if (!isNeeded || columns.column[i]) continue;
        std::string message = "names no '";
        message += kPointValueNames[i];
        message += i < kNormalValue ? "'; expected x, y and z" : "'; expected nx, ny and nz";
        fail(message);
    }
    return columns;
}

/// Reads the points of a .ply file.
struct FileContents;
PointCloud readPlyPoints(const FileContents& file, Progress& progress);

/// Reads the points of a table in text.
PointCloud readTextPoints(const FileContents& file, Progress& progress);

}  // namespace bandvox
