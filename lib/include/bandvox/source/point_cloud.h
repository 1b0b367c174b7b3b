#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// Points, and what is known at each of them.
struct PointCloud {
    std::vector<openvdb::Vec3d> points;   ///< world units, finite
    std::vector<openvdb::Vec3f> normals;  ///< one for each point, of any length; empty without
    std::vector<double> radii;            ///< world units, 0 or more; empty without
};

/// Extensions of files that hold points and nothing else, lower case with the dot: .xyz .csv .txt.
const std::vector<std::string>& pointCloudExtensions();

/// True if the path ends like one of those, or is a .ply file whose header tells of no faces.
bool isPointCloudFile(const std::filesystem::path& path);

/// Reads points from a .ply, .xyz, .csv or .txt file.
///
/// .ply: text or binary; of its element "vertex" the properties x y z, nx ny nz, and a radius.
/// Others: a line for each point, its numbers separated by semicolons, tabs, commas or blanks,
/// whatever the first line has of these, in this order. If that line has a word that is no number,
/// it names the columns, in any order; what has another name is passed over. Without one there are
/// 3 columns (x y z), 4 (and the radius) or 6 (and the normal). Lines that are empty or begin with
/// "#" or "//" are passed over, unless the first one names x, y and z.
///
/// A radius is named radius, pscale or scale, or is half of a width or diameter; upper and lower
/// case are alike.
///
/// Throws Error(ErrorKind::Input), naming the file, the line or point, what was found and what was
/// expected, if the file is missing, a folder, empty, of an unknown kind, cut short, without points
/// or coordinates, or has rows of different lengths, a word where a number belongs, a number that
/// is not finite or that single precision cannot hold, a negative radius, or, where no names say
/// that they are normals, columns 4 to 6 longer than 2; Error(ErrorKind::Interrupted).
PointCloud readPointCloud(const std::filesystem::path& path, Progress& progress = silentProgress());

}  // namespace bandvox
