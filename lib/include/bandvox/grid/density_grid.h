#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

namespace bandvox {

class AtomicFile;

/// What a density grid says of itself, stored as grid metadata named `bandvox_<member>` in
/// snake_case (bandvox_version, bandvox_closure_error, ...).
struct DensityMetadata {
    std::string version;          ///< of the library that made it
    std::string source;           ///< file or shape it was made from
    std::string route = "exact";  ///< "exact", "sampled" or "winding"; "merged" of several;
                                  ///< "filtered" by this library of another program's grid
    double order = 0;             ///< of the exponential filter
    double cutoff = 0;            ///< of the exponential filter, cycles per voxel
    double oversampling = 0;      ///< R/N of the sampled route, rows to a voxel's side of
                                  ///< that of the winding number; 0 for the exact route
    double iso = 0.5;             ///< density that is the surface
    double tolerance = 0;         ///< error asked for, that of sampling apart, density
    double closureError = 0;      ///< measured by the exact route while writing, density
    double samplingError = 0;     ///< measured by the other two routes while writing, density;
                                  ///< NaN if it is not known, 0 for the exact route
    double storageError = 0;      ///< largest change by rounding to 16 bits, density; 0 without
    double sourceVolume = 0;      ///< enclosed by the source, world units³; 0 if it is not known,
                                  ///< as it is not for a field
    double gridVolume = 0;        ///< integral of the density, world units³
    int holesCapped = 0;          ///< boundary loops of the source that were closed
    bool clamped = false;         ///< values were limited to [0, 1]
};

/// Stores `metadata` in `grid`, replacing what was there.
void setDensityMetadata(openvdb::GridBase& grid, const DensityMetadata& metadata);

/// What `grid` says of itself, or nothing if it does not name the filter that it was made with:
/// then it is no band-limited density of this library.
std::optional<DensityMetadata> densityMetadata(const openvdb::GridBase& grid);

/// True if `grid` is a density of this library that stands for a solid: of other programs' grids
/// that were filtered that is not known.
bool isDensityOfSolid(const openvdb::GridBase& grid);

/// What a grid says of its world, stored as bandvox_unit and bandvox_space; empty if not known.
struct PlaceMetadata {
    std::string unit;   ///< of lengths, as "mm"
    std::string space;  ///< where the axes point, as "LPS" or "left-posterior-superior"
};

PlaceMetadata placeMetadata(const openvdb::GridBase& grid);

/// Stores what is known, and leaves the rest as it was.
void setPlaceMetadata(openvdb::GridBase& grid, const PlaceMetadata& place);

/// Stores in a grid what made it and from what: bandvox_version and bandvox_source.
void setSourceMetadata(openvdb::GridBase& grid, const std::string& source);

/// Stores in a grid of binary voxels what it can say of itself: bandvox_version, bandvox_source,
/// and bandvox_iso = 0.5. For densityMetadata it stays a grid of unknown origin.
void setVoxelMetadata(openvdb::GridBase& grid, const std::string& source);

/// What a grid of this library, of densities, colours or binary voxels, was made from; empty of
/// others.
std::string sourceOf(const openvdb::GridBase& grid);

/// Integral of the density: the sum of all active values times a voxel's volume, world units³.
/// Summed in one order, so the same for any number of threads. Throws
/// Error(ErrorKind::Interrupted).
double densityIntegral(const openvdb::FloatGrid& grid, Progress& progress = silentProgress());

/// Rounds every value to what 16 bits hold, which is what a file of such values gives back.
/// Returns the largest change, density: up to 2^-12 below 1, 2^-11 above. Throws
/// Error(ErrorKind::Interrupted), with some values rounded.
double roundToHalf(openvdb::FloatGrid& grid, Progress& progress = silentProgress());

/// The same, and says so in the grid if that is a density.
void roundAndRestate(openvdb::FloatGrid& grid, Progress& progress = silentProgress());

/// How a VDB file is written.
struct VdbWriteOptions {
    bool half = false;  ///< 16-bit values
    enum class Compression { Blosc, Zip, None } compression = Compression::Blosc;
};

/// Writes grids to a .vdb file, whole or not at all.
/// Throws Error(ErrorKind::Runtime) if it cannot be written; Error(ErrorKind::Interrupted).
void writeVdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
              const VdbWriteOptions& options = {}, Progress& progress = silentProgress());

/// The same to a file that the caller commits.
void writeVdb(AtomicFile& file, const openvdb::GridCPtrVec& grids,
              const VdbWriteOptions& options = {}, Progress& progress = silentProgress());

/// Reads all grids of a .vdb file. Throws Error(ErrorKind::Input) if it is missing, not a VDB,
/// or damaged; Error(ErrorKind::Interrupted).
openvdb::GridPtrVec readVdb(const std::filesystem::path& path,
                            Progress& progress = silentProgress());

/// The same from a stream that need not be seekable, as the standard input: all that it holds is
/// taken into memory. Errors call it `name`.
openvdb::GridPtrVec readVdb(std::istream& stream, const std::string& name,
                            Progress& progress = silentProgress());

}  // namespace bandvox
