#pragma once

#include "source/file_integrity.h"

#include <bandvox/scatter/read_scattered_points.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

/// Takes rows one after another, of which some columns count.
class PointTaker {
  public:
    /// `names`: of the file's columns, empty if it has none.
    PointTaker(const FileContents& file, std::size_t width, std::vector<std::string> names,
               const PointColumnChoice& choice);

    const std::vector<std::size_t>& columns() const { return mColumns; }

    /// The names of what is taken.
    std::string nameOf(std::size_t i) const {
        if (i < mPlaces) return i == 0 ? "x" : i == 1 ? "y" : "z";
        if (!mNames.empty()) return mNames[mColumns[i]];
        if (mColumns.size() == mPlaces + 1) return "value";
        return "value " + std::to_string(i - mPlaces + 1);
    }

    /// `row`: the numbers of the chosen columns. `line`: where they stand. Calls `fail(what)`,
    /// which throws.
    template <typename Fail>
    void add(const std::vector<double>& row, std::size_t line, const Fail& fail) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (std::isfinite(row[i])) continue;
            std::string message = "has ";
            message += std::isnan(row[i]) ? "nan" : "inf";
            message += " as " + nameOf(i);
            message += "; expected a finite number";
            fail(message);
        }
        mPoints.x.push_back(row[0]);
        mPoints.y.push_back(row[1]);
        if (mPlaces == 3) mPoints.z.push_back(row[2]);
        mPoints.values.insert(mPoints.values.end(),
                              row.begin() + static_cast<std::ptrdiff_t>(mPlaces), row.end());
        mPoints.lines.push_back(static_cast<std::uint32_t>(line));
    }

    ScatteredPoints take(const std::string& lineWord) {
        mPoints.columns = static_cast<int>(mColumns.size() - mPlaces);
        mPoints.lineWord = lineWord;
        for (std::size_t i = mPlaces; i < mColumns.size(); ++i) mPoints.names.push_back(nameOf(i));
        return std::move(mPoints);
    }

  private:
    std::size_t chosen(const std::string& name, std::size_t width) const;

    std::size_t mPlaces;  // columns of a place
    std::vector<std::string> mNames;
    std::vector<std::size_t> mColumns;
    ScatteredPoints mPoints;
};

}  // namespace bandvox
