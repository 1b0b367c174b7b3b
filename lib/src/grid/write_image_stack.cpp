#include "core/image_library.h"
#include "core/number_pattern.h"
#include "grid/voxel_slices.h"
#include "source/image_calibration.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/write_image_stack.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <system_error>

namespace bandvox {

namespace {

namespace fs = std::filesystem;

// Classic TIFF counts bytes with 32 bits; some are left for what is not pixels.
constexpr double kLargestTiff = 4.0e9;

std::string imageExtension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".tiff" ? ".tif" : extension;
}

std::vector<VoxelType> typesOf(const std::string& extension) {
    using enum VoxelType;
    if (extension == ".png") return {UInt8, UInt16};
    if (extension == ".exr") return {Half, Float};
    return {UInt8, UInt16, Int16, Float, Double};
}

std::string storedType(VoxelType type) {
    if (type == VoxelType::Half) return "float16";
    if (type == VoxelType::Float) return "float32";
    if (type == VoxelType::Double) return "float64";
    return voxelTypeNames()[static_cast<std::size_t>(type)];
}

openvdb::Vec3d spacingOf(const openvdb::FloatGrid& grid) {
    return grid.transform().voxelSize();
}

SliceOutputInfo outputInfo(const fs::path& path, const VoxelSlices& slices,
                           const ImageStackOptions& options) {
    SliceOutputInfo info;
    info.width = slices.size().x();
    info.height = slices.size().y();
    info.type = storedType(options.voxels.type);
    info.extension = imageExtension(path);
    info.compress = options.compress;
    return info;
}

// Tells TIFF files how large voxels are, in the way of ImageJ, which is read back.
void calibrateOutput(const openvdb::FloatGrid& grid, int pages, SliceOutputInfo& info) {
    if (info.extension != ".tif") return;
    const openvdb::Vec3d spacing = spacingOf(grid);
    info.resolution = {1 / spacing[0], 1 / spacing[1]};
    info.description = calibrationText(pages, spacing[2], placeMetadata(grid).unit);
}

[[noreturn]] void failImage(const fs::path& path, const Error& error) {
    throw Error(error.kind(), "cannot write " + path.string() + ": " + error.what());
}

void requireReplaceable(const AtomicFile& file) {
    if (!file.inPlace()) return;
    throw Error(ErrorKind::Usage, "images cannot be written to '" + file.target().string() +
                                      "', which is a device or a pipe; expected a file");
}

// Slices of an older, longer stack would pass for slices of this one.
void requireNoOthers(const fs::path& path, const NumberPattern& pattern, int slices) {
    std::error_code error;
    fs::directory_iterator entries(pattern.folder(), error);
    const bool inFolder = pattern.before.find('/') != std::string::npos;
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        const fs::path entry = inFolder ? entries->path() : entries->path().filename();
        const auto number = pattern.numberOf(entry);
        if (!number || *number < slices) continue;
        throw Error(ErrorKind::Runtime, "cannot write " + path.string() + ": the stack has " +
                                            std::to_string(slices) +
                                            " slices, and there is a file " + entry.string() +
                                            " that would pass for one; expected no such files");
    }
}

NumberPattern patternOf(const fs::path& path) {
    const auto pattern = NumberPattern::parse(path);
    if (pattern) return *pattern;
    throw Error(ErrorKind::Usage, "the name '" + path.string() +
                                      "' has no place for the number of a slice; expected one, as "
                                      "in slice.####.tif");
}

}  // namespace

bool isWritableImage(const fs::path& path) {
    const std::string extension = imageExtension(path);
    return extension == ".tif" || extension == ".png" || extension == ".exr";
}

bool isImagePattern(const fs::path& path) {
    return NumberPattern::parse(path).has_value();
}

VoxelType usualImageType(const fs::path& path) {
    return imageExtension(path) == ".png" ? VoxelType::UInt16 : VoxelType::Float;
}

void requireImageType(const fs::path& path, VoxelType type) {
    const std::vector<VoxelType> types = typesOf(imageExtension(path));
    if (std::find(types.begin(), types.end(), type) == types.end()) {
        std::string known;
        for (const VoxelType one : types) {
            if (!known.empty()) known += ", ";
            known += voxelTypeNames()[static_cast<std::size_t>(one)];
        }
        throw Error(ErrorKind::Usage, "a file '" + path.string() + "' holds no values of type " +
                                          voxelTypeNames()[static_cast<std::size_t>(type)] +
                                          "; expected " + known);
    }
    if (imageExtension(path) != ".tif") patternOf(path);
}

fs::path sliceFile(const fs::path& pattern, int slice) {
    return patternOf(pattern).with(slice);
}

WrittenVoxels writeImageStack(const fs::path& path, const openvdb::FloatGrid& grid,
                              const ImageStackOptions& options, Progress& progress) {
    requireImageType(path, options.voxels.type);
    const NumberPattern pattern = patternOf(path);
    VoxelSlices slices(grid, options.voxels, {0, 1, 2});
    requireNoOthers(path, pattern, slices.slices());
    SliceOutputInfo info = outputInfo(path, slices, options);
    calibrateOutput(grid, 1, info);
    const ProgressStage stage(progress, "writing", slices.slices());
    int first = 0;
    while (const int count = slices.together()) {
        progress.throwIfInterrupted();
        const std::vector<char>& bytes = slices.next();
        parallelFor(count, [&](std::int64_t i) {
            AtomicFile file(pattern.with(first + static_cast<int>(i)));
            requireReplaceable(file);
            file.open().close();
            try {
                const auto output = imageLibrary().createSlices(file.temporary(), info);
                output->write(&bytes[static_cast<std::size_t>(i) * slices.bytesPerSlice()]);
                output->close();
            } catch (const Error& error) {
                failImage(file.target(), error);
            }
            file.commit();
            progress.advance();
        });
        first += count;
    }
    return slices.result();
}

WrittenVoxels writeImagePages(AtomicFile& file, const openvdb::FloatGrid& grid,
                              const ImageStackOptions& options, Progress& progress) {
    requireImageType(file.target(), options.voxels.type);
    requireReplaceable(file);
    VoxelSlices slices(grid, options.voxels, {0, 1, 2});
    SliceOutputInfo info = outputInfo(file.target(), slices, options);
    info.large = double(slices.bytesPerSlice()) * slices.slices() > kLargestTiff;
    info.threads = threadCount();
    calibrateOutput(grid, slices.slices(), info);
    file.open().close();
    const ProgressStage stage(progress, "writing", slices.slices());
    try {
        const auto output = imageLibrary().createSlices(file.temporary(), info);
        while (const int count = slices.together()) {
            progress.throwIfInterrupted();
            const std::vector<char>& bytes = slices.next();
            for (int i = 0; i < count; ++i) {
                output->write(&bytes[static_cast<std::size_t>(i) * slices.bytesPerSlice()]);
            }
            progress.advance(count);
        }
        output->close();
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Interrupted) throw;
        failImage(file.target(), error);
    }
    return slices.result();
}

}  // namespace bandvox
