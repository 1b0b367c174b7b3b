#pragma once

#include "convert_job.h"
#include "convert_to_array.h"
#include "iso_option.h"
#include "mesh_output.h"
#include "output_kind.h"

#include <bandvox/bandlimit/density.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/openvdb.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

// What convert makes of the density of a solid, wherever that came from.
namespace bandvox::app {

/// Where a solid goes, and as what.
struct SolidOutput {
    std::filesystem::path path;
    std::optional<MeshOutput> mesh;      ///< instead of a volume
    std::unique_ptr<ArrayOutput> array;  ///< the same
    OutputKind kind;
    IsoOption iso;
    int levels = 0;  ///< coarser ones beside the density
    VdbWriteOptions write;
    std::int64_t memoryLimit = 0;  ///< bytes; a density that keeps one is made as it is written

    /// The file; nothing for an array, which has its own.
    std::optional<AtomicFile> openFile() const;
};

/// The options of the output, of --iso and of --lod. Throws Error(ErrorKind::Usage) for those that
/// have no meaning with others; `noun` is what the input is, as in "a solid".
SolidOutput readSolidOutput(const CommandLine& line, const std::string& noun);

/// The options of how a solid becomes a density: --cutoff, --order, --tile, --clamp, --iso and
/// --shard. The voxel size and the tolerance are left to the caller.
void readDensityOptions(const CommandLine& line, const SolidOutput& output,
                        DensityOptions& density);

/// Rounds the density if that is asked for, and has not been done, finds its iso-value, and stores
/// in the grid what is known of it.
void finishDensity(CommandRun& run, const SolidOutput& output, const openvdb::FloatGrid::Ptr& grid,
                   DensityMetadata& metadata);

/// The error of the exact route in words, as sayDensity takes it.
std::string exactErrorInWords(const SolidOutput& output, const DensityMetadata& metadata);

/// What rounding adds to it; empty if nothing is rounded.
std::string storageErrorInWords(const SolidOutput& output, const DensityMetadata& metadata);

/// Writes the density as what is asked for: the last step of a command. Its levels of detail have
/// the filter and the tolerance of `density`; `colors` is a grid to be written beside, or null.
void writeSolid(ConvertJob& job, std::optional<AtomicFile>& file, const SolidOutput& output,
                const DensityOptions& density, const openvdb::FloatGrid::Ptr& grid,
                const openvdb::Vec3SGrid::Ptr& colors = nullptr);

}  // namespace bandvox::app
