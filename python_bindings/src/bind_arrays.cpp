// Files of arrays, slices and scans to grids, and grids to such files.

#include "arrays.h"
#include "background.h"
#include "bindings.h"
#include "choices.h"
#include "errors.h"
#include "grid_object.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/array_to_grid.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/grid_place.h>
#include <bandvox/grid/write_array.h>
#include <bandvox/grid/write_image_stack.h>
#include <bandvox/source/array_source.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>

namespace bandvox::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kSpaces{"LPS", "RAS"};

/// What kind of files hold an array.
enum class ArrayKind { Npy, Nrrd, MetaImage, Pages, Pattern };

std::string lowerExtension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

ArrayKind kindOf(const fs::path& path) {
    const std::string extension = lowerExtension(path);
    if (extension == ".npy") return ArrayKind::Npy;
    if (extension == ".nrrd" || extension == ".nhdr") return ArrayKind::Nrrd;
    if (extension == ".mha" || extension == ".mhd") return ArrayKind::MetaImage;
    if (isWritableImage(path)) return isImagePattern(path) ? ArrayKind::Pattern : ArrayKind::Pages;
    throw Error(ErrorKind::Usage, "'" + path.string() +
                                      "' is of an unknown kind; expected .npy, .nrrd, .nhdr, "
                                      ".mha, .mhd, .tif, or images as in slice.####.png");
}

struct ArrayRequest {
    fs::path path;
    ArrayKind kind = ArrayKind::Npy;
    VoxelsToWrite voxels;
    bool compress = false;

    bool isImages() const { return kind == ArrayKind::Pages || kind == ArrayKind::Pattern; }
};

openvdb::CoordBBox boxOfVoxels(const py::handle& object) {
    const std::vector<openvdb::Vec3d> corners = vectorsOf(object, "box");
    constexpr double kFarthest = 1 << 30;
    const auto isVoxel = [](const openvdb::Vec3d& place) {
        return std::all_of(place.asPointer(), place.asPointer() + 3,
                           [](double x) { return x == std::floor(x) && std::abs(x) <= kFarthest; });
    };
    if (corners.size() == 2 && isVoxel(corners[0]) && isVoxel(corners[1])) {
        const openvdb::CoordBBox box(openvdb::Coord::round(corners[0]),
                                     openvdb::Coord::round(corners[1]));
        if (!box.empty()) return box;
    }
    throw Error(ErrorKind::Usage, "box: found " + py::repr(object).cast<std::string>() +
                                      "; expected the first voxel and the last, whole numbers");
}

/// Whether values are packed: as is usual, unless `compression` says.
bool compresses(const ArrayRequest& request, const py::object& compression) {
    if (compression.is_none()) return request.isImages();
    const bool isZip =
        choiceOf(compression.cast<std::string>(), {"zip", "none"}, "compression") == 0;
    if (isZip && request.kind == ArrayKind::Npy) {
        throw Error(ErrorKind::Usage, "compression is 'zip', and .npy files never are compressed");
    }
    if (!isZip && request.isImages() && lowerExtension(request.path) == ".png") {
        throw Error(ErrorKind::Usage,
                    "compression is 'none', and .png files always are "
                    "compressed");
    }
    return isZip;
}

/// Where the values of a header that stands alone go; empty if they follow it.
fs::path valuesBeside(const ArrayRequest& request) {
    const std::string extension = lowerExtension(request.path);
    if (extension != ".nhdr" && extension != ".mhd") return {};
    fs::path values = request.path;
    // As these formats usually call it.
    values.replace_extension(!request.compress                 ? ".raw"
                             : request.kind == ArrayKind::Nrrd ? ".raw.gz"
                                                               : ".zraw");
    std::error_code ignored;
    if (!fs::exists(values, ignored) || fs::exists(request.path, ignored)) return values;
    throw Error(ErrorKind::Usage, "the values of '" + request.path.string() + "' would replace '" +
                                      values.string() +
                                      "', which may be those of another file; expected another "
                                      "name");
}

WrittenVoxels writeFiles(const ArrayRequest& request, const openvdb::FloatGrid& grid,
                         Progress& progress) {
    if (request.kind == ArrayKind::Pattern) {
        return writeImageStack(request.path, grid, {request.voxels, request.compress}, progress);
    }
    AtomicFile file(request.path);
    WrittenVoxels written;
    if (request.kind == ArrayKind::Pages) {
        written = writeImagePages(file, grid, {request.voxels, request.compress}, progress);
        file.commit();
        return written;
    }
    const ArrayFormat format = request.kind == ArrayKind::Npy    ? ArrayFormat::Npy
                               : request.kind == ArrayKind::Nrrd ? ArrayFormat::Nrrd
                                                                 : ArrayFormat::MetaImage;
    std::unique_ptr<AtomicFile> values;
    if (const fs::path beside = valuesBeside(request); !beside.empty()) {
        values = std::make_unique<AtomicFile>(beside);
    }
    written =
        writeArray(file, values.get(), format, grid, {request.voxels, request.compress}, progress);
    // A header that stands alone comes last: where it is, its values are.
    if (values) values->commit();
    file.commit();
    return written;
}

void warnOfValues(const WrittenVoxels& written) {
    std::vector<std::string> warnings;
    if (written.clipped > 0) {
        warnings.push_back(std::to_string(written.clipped) +
                           " values were beyond what is stored, and clipped; the values are " +
                           std::to_string(written.minimum) + " to " +
                           std::to_string(written.maximum) + " (range, type)");
    }
    if (written.rounded > 0 && written.minimum >= -0.5 && written.maximum <= 1.5) {
        warnings.emplace_back(
            "all values are near 0 to 1 and were rounded to whole numbers; range=(0, 1) would "
            "spread them");
    }
    warn(warnings);
}

void writeGridArray(const fs::path& path, const py::object& object, const py::object& type,
                    const std::optional<std::array<double, 2>>& range, const py::object& box,
                    const py::object& compression, int threads, const py::object& progress) {
    const auto grid = floatGridOf(object);
    ArrayRequest request{path, kindOf(path)};
    VoxelsToWrite& voxels = request.voxels;
    voxels.type = request.isImages() ? usualImageType(path) : VoxelType::Float;
    if (!type.is_none()) {
        voxels.type =
            static_cast<VoxelType>(choiceOf(type.cast<std::string>(), voxelTypeNames(), "type"));
    }
    if (request.isImages()) requireImageType(path, voxels.type);
    voxels.range = range;
    if (range && !((*range)[0] < (*range)[1])) {
        throw Error(ErrorKind::Usage, "range: expected two numbers, the lower one first");
    }
    const bool isWhole = voxels.type == VoxelType::UInt8 || voxels.type == VoxelType::UInt16 ||
                         voxels.type == VoxelType::Int16;
    // Densities that are asked for as whole numbers fill these.
    if (isWhole && !range && isDensityOfSolid(*grid)) voxels.range = {0, 1};
    if (!box.is_none()) voxels.box = boxOfVoxels(box);
    request.compress = compresses(request, compression);
    warnOfValues(inBackground(
        progress, threads, [&](Progress& watched) { return writeFiles(request, *grid, watched); }));
}

py::object readGridArray(const fs::path& path, const std::string& channel,
                         const std::string& series, const py::object& spacing,
                         const py::object& origin, const py::object& space, double background,
                         int threads, const py::object& progress) {
    std::optional<openvdb::Vec3d> step, first;
    if (!spacing.is_none()) step = vectorOf(spacing, "spacing");
    if (!origin.is_none()) first = vectorOf(origin, "origin");
    std::string turned;
    if (!space.is_none()) {
        turned = kSpaces[choiceOf(space.cast<std::string>(), kSpaces, "space")];
    }
    const auto grid = inBackground(progress, threads, [&](Progress& watched) {
        const auto source = openArray(path, {channel, series});
        source->place(step, first);
        if (!turned.empty()) source->turnTo(turned);
        return arrayToGrid(*source, {static_cast<float>(background), 0}, watched);
    });
    return objectOf(grid);
}

}  // namespace

void bindArrays(py::module_& module) {
    module.def("read_array", &readGridArray, py::arg("path"), py::kw_only(),
               py::arg("channel") = "", py::arg("series") = "", py::arg("spacing") = py::none(),
               py::arg("origin") = py::none(), py::arg("space") = py::none(),
               py::arg("background") = 0.0, py::arg("threads") = 0,
               py::arg("progress") = py::none(),
               R"(A file or folder of an array, of slices or of a scan as a Grid.

path: .npy, .nrrd, .nhdr, .mha, .mhd, an image with pages, a folder or a pattern of images as
slice.####.tif, or a file or folder of DICOM. channel: of images with several, 'R', 'G', 'B', 'A',
'luminance' or a number; series: of DICOM, its UID or number. spacing: world units from voxel to
voxel, one number or three, and origin, the centre of the first voxel, instead of what the file
says. space: 'LPS' or 'RAS', where the axes are to point. background: the value that is nothing,
and not stored. Raises InputError.)");
    module.def("write_array", &writeGridArray, py::arg("path"), py::arg("grid"), py::kw_only(),
               py::arg("type") = py::none(), py::arg("range") = py::none(),
               py::arg("box") = py::none(), py::arg("compression") = py::none(),
               py::arg("threads") = 0, py::arg("progress") = py::none(),
               R"(Writes the voxels of a box as a .npy, .nrrd, .nhdr, .mha or .mhd file, as pages of
a .tif file, or as images named by a pattern, slice.####.png, .exr or .tif.

type: 'uint8', 'uint16', 'int16', 'half', 'float' or 'double'; by default 'float', and 'uint16' of
.png. range: of whole numbers, the values that become 0 and the largest one; (0, 1) of densities,
others are rounded. box: the first voxel and the last; by default that of the array which the grid
was made from, else that of the active voxels. compression: 'zip' or 'none'.)");
}

}  // namespace bandvox::python
