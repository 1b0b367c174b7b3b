#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/scatter/scattered_points.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// Which columns of a table are what.
struct PointColumnChoice {
    /// Names, or numbers from 1: x, y, and a value or several. Empty: the columns named x and y, or
    /// the first two, and all others.
    std::vector<std::string> columns;
    /// The places are in space: after x and y comes z.
    bool isInSpace = false;
};

/// Reads a table of places and values. Columns that the file has no names for become "value", or
/// "value 1" and so on.
///
/// .csv .xyz .txt: a line for each point, its numbers separated by semicolons, tabs, commas or
/// blanks. If no word of the first line is a number, it names the columns. Lines that are
/// empty or begin with "#" or "//" are passed over. .npy: [point][column], float or double,
/// little-endian, in C order.
///
/// Throws Error(ErrorKind::Input), naming the file, the line or row, what was found and what was
/// expected, if the file is missing, of an unknown kind, cut short or without points, has rows of
/// different lengths, too few columns, a word where a number belongs or a number that is
/// not finite; Error(ErrorKind::Usage) for columns that are not there or chosen twice;
/// Error(ErrorKind::Interrupted).
ScatteredPoints readScatteredPoints(const std::filesystem::path& path,
                                    const PointColumnChoice& choice = {},
                                    Progress& progress = silentProgress());

}  // namespace bandvox
