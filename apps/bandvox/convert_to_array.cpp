// bandvox convert to an array (.npy, .nrrd, .mha, ...) or a stack of images.

#include "convert_to_array.h"

#include "mesh_output.h"
#include "standard_streams.h"
#include "words.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/write_image_stack.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace bandvox::app {
namespace {

namespace fs = std::filesystem;

// Densities that are asked for as whole numbers fill these.
constexpr std::array<double, 2> kDensityRange{0, 1};

constexpr const char* kArrayOptions[] = {"type", "range", "box"};

bool holdsValuesBeside(const fs::path& path) {
    return extensionOf(path) == ".nhdr" || extensionOf(path) == ".mhd";
}

std::optional<std::array<double, 2>> readRange(const CommandLine& line) {
    const std::string expected = "two numbers separated by a comma, the lower one first, as in 0,1";
    const auto range = line.numbers("range", 2, 2, expected, kAnyPlace);
    if (!range) return std::nullopt;
    if (!((*range)[0] < (*range)[1])) line.fail("range", expected);
    return std::array{(*range)[0], (*range)[1]};
}

std::optional<openvdb::CoordBBox> readBox(const CommandLine& line) {
    const auto numbers = line.wholeNumbers("box", 6, ',');
    if (!numbers) return std::nullopt;
    const std::vector<int>& n = *numbers;
    const openvdb::CoordBBox box(n[0], n[1], n[2], n[3], n[4], n[5]);
    if (box.empty()) line.fail("box", "the first voxel before the last one along each axis");
    return box;
}

bool isAlongAxes(const openvdb::FloatGrid& grid) {
    const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            if (row != column && std::abs(matrix(row, column)) > 1e-9 * std::abs(matrix(row, row)))
                return false;
        }
        if (matrix(row, row) < 0) return false;
    }
    return true;
}

// Slices may not be written over those that are read, nor among them.
void requireOtherFiles(const std::string& input, const fs::path& output) {
    std::error_code ignored;
    const fs::path first = sliceFile(output, 0);
    const fs::path folder = first.has_parent_path() ? first.parent_path() : fs::path(".");
    const bool isThere = fs::is_directory(input, ignored)
                             ? fs::equivalent(input, folder, ignored)
                             : isImagePattern(input) && fs::weakly_canonical(sliceFile(input, 0)) ==
                                                            fs::weakly_canonical(first);
    if (!isThere) return;
    throw Error(ErrorKind::Usage, "option --output is '" + output.string() +
                                      "', where the slices of INPUT are; expected another place");
}

// A file of values is replaced with its header only: it could be that of another one.
void requireOwnValues(const fs::path& header, const fs::path& values) {
    std::error_code ignored;
    if (!fs::exists(values, ignored) || fs::exists(header, ignored)) return;
    throw Error(ErrorKind::Usage, "the values of '" + header.string() + "' would replace '" +
                                      values.string() +
                                      "', which may be those of another file; expected another "
                                      "name for --output");
}

}  // namespace

std::vector<OptionEntry> arrayOutputEntries() {
    const std::string output = "Output";
    return {
        {"type",
         0,
         "KIND",
         "float, of .png uint16",
         "Of an array or images: " + joined(voxelTypeNames(), ", ") + ".",
         output,
         {.words = voxelTypeNames()}},
        {"range", 0, "LO,HI", "0,1 of densities",
         "Of an array or images of whole numbers: the values that become 0 and the largest one. "
         "Values that are no densities stay as they are, rounded.",
         output},
        {"box", 0, "X0,Y0,Z0,X1,Y1,Z1", "the array's own",
         "Of an array or images: the first and the last voxel to write. Of a grid that was no "
         "array it is the box of its active voxels.",
         output},
    };
}

std::optional<ArrayOutput::Kind> ArrayOutput::kindOf(const std::string& name) {
    const std::string extension = extensionOf(name);
    if (extension == ".npy") return Kind::Npy;
    if (extension == ".nrrd" || extension == ".nhdr") return Kind::Nrrd;
    if (extension == ".mha" || extension == ".mhd") return Kind::MetaImage;
    if (!isWritableImage(name)) return std::nullopt;
    return isImagePattern(name) ? Kind::Pattern : Kind::Pages;
}

bool isArrayOutput(const std::string& name) {
    return ArrayOutput::kindOf(name).has_value();
}

std::unique_ptr<ArrayOutput> ArrayOutput::read(const CommandLine& line) {
    const std::string output = line.requiredText("output");
    const auto kind = kindOf(output);
    if (!kind) {
        refuseOptions(line, {std::begin(kArrayOptions), std::end(kArrayOptions)},
                      "unless the output is an array or a stack of images");
        return nullptr;
    }
    refuseOptions(line, {"half", "lod", "adaptivity", "color", "shard"},
                  "with an array or a stack of images as the output");
    return std::unique_ptr<ArrayOutput>(new ArrayOutput(line, outputPath(output), *kind));
}

ArrayOutput::ArrayOutput(const CommandLine& line, fs::path path, Kind kind)
    : mPath(std::move(path)), mKind(kind), mInput(line.positional(0)) {
    const bool isPng = isImages() && extensionOf(mPath) == ".png";
    const VoxelType usual = isImages() ? usualImageType(mPath) : VoxelType::Float;
    mVoxels.type = static_cast<VoxelType>(line.choice("type", static_cast<std::size_t>(usual)));
    mVoxels.range = readRange(line);
    mVoxels.box = readBox(line);
    if (isImages()) requireImageType(mPath, mVoxels.type);
    // 0: as is usual, 1: zip, 2: none.
    const std::size_t packing =
        line.has("compression") ? 1 + line.choice("compression", {"zip", "none"}, 0) : 0;
    if ((packing == 1 && mKind == Kind::Npy) || (packing == 2 && isPng)) {
        throw Error(ErrorKind::Usage,
                    std::string("--compression has no meaning with ") +
                        (isPng ? ".png files, which always are" : ".npy files, which never are"));
    }
    mCompress = isImages() ? packing != 2 : packing == 1;
    // What cannot be written is to be known before the work.
    if (mKind == Kind::Pattern) {
        requireOtherFiles(mInput, mPath);
        const AtomicFile first(sliceFile(mPath, 0));
        return;
    }
    mFile = std::make_unique<AtomicFile>(mPath);
    if (holdsValuesBeside(mPath)) {
        fs::path values = mPath;
        // As these formats usually call it.
        values.replace_extension(mCompress ? (mKind == Kind::Nrrd ? ".raw.gz" : ".zraw") : ".raw");
        requireOwnValues(mPath, values);
        mValues = std::make_unique<AtomicFile>(values);
    }
}

void ArrayOutput::writePattern(CommandRun& run, const openvdb::FloatGrid& grid) {
    // A warning that is a failure has to come before the first file.
    say(run, grid, examineVoxels(grid, mVoxels, run.progress()));
    const WrittenVoxels written =
        writeImageStack(mPath, grid, {mVoxels, mCompress}, run.progress());
    run.say("wrote    " + sliceFile(mPath, 0).string() + " to " +
            sliceFile(mPath, written.box.dim().z() - 1).filename().string() + ", after " +
            formatNumber(run.seconds(), 3) + " s");
    run.finish();
}

WrittenVoxels ArrayOutput::writeFiles(CommandRun& run, const openvdb::FloatGrid& grid) {
    if (mKind == Kind::Pages) {
        return writeImagePages(*mFile, grid, {mVoxels, mCompress}, run.progress());
    }
    const ArrayFormat format = mKind == Kind::Npy    ? ArrayFormat::Npy
                               : mKind == Kind::Nrrd ? ArrayFormat::Nrrd
                                                     : ArrayFormat::MetaImage;
    return writeArray(*mFile, mValues.get(), format, grid, {mVoxels, mCompress}, run.progress());
}

void ArrayOutput::say(CommandRun& run, const openvdb::FloatGrid& grid,
                      const WrittenVoxels& written) const {
    const openvdb::Coord size = written.box.dim();
    const openvdb::Coord low = written.box.min();
    run.say("voxels   " + std::to_string(size.x()) + " x " + std::to_string(size.y()) + " x " +
            std::to_string(size.z()) + " of type " +
            voxelTypeNames()[static_cast<std::size_t>(mVoxels.type)] + " from (" +
            std::to_string(low.x()) + ", " + std::to_string(low.y()) + ", " +
            std::to_string(low.z()) + ") on, values " + formatNumber(written.minimum) + " to " +
            formatNumber(written.maximum));
    if (mKind == Kind::Npy) {
        run.say("         a .npy file does not say where its voxels lie");
    } else if (isImages() && !isAlongAxes(grid)) {
        run.say("         images do not say how the grid is turned");
    }
    run.count("array_voxels", written.count);
    run.count("clipped_voxels", written.clipped);
    std::vector<std::string> warnings;
    if (written.clipped > 0) {
        warnings.push_back(formatCount(written.clipped, "value was", "values were") +
                           " beyond what is stored, and clipped; the values are " +
                           formatNumber(written.minimum) + " to " + formatNumber(written.maximum) +
                           " (--range, --type)");
    }
    if (written.rounded > 0 && written.minimum >= -0.5 && written.maximum <= 1.5) {
        warnings.emplace_back(
            "all values are near 0 to 1 and were rounded to whole numbers; --range 0,1 would "
            "spread them");
    }
    run.warn(warnings, ErrorKind::Result);
}

void ArrayOutput::write(CommandRun& run, const openvdb::FloatGrid& grid) {
    const bool isWhole = mVoxels.type == VoxelType::UInt8 || mVoxels.type == VoxelType::UInt16 ||
                         mVoxels.type == VoxelType::Int16;
    if (isWhole && !mVoxels.range && isDensityOfSolid(grid)) mVoxels.range = kDensityRange;
    if (mKind == Kind::Pattern) return writePattern(run, grid);
    // A header that stands alone comes last: where it is, its values are.
    run.writeOutput(*mFile, [&](AtomicFile& /*file*/) {
        const WrittenVoxels written = writeFiles(run, grid);
        say(run, grid, written);
        if (mValues) mValues->commit();
    });
}

}  // namespace bandvox::app
