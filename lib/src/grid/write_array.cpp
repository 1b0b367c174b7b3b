#include "grid/array_header_text.h"
#include "grid/voxel_slices.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/write_array.h>

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <string_view>

namespace bandvox {

namespace {

// Between speed and size: what is left of scans is mostly noise.
constexpr int kPackingLevel = 3;

// Bytes that are written as they are, or packed.
class PackedOutput {
  public:
    enum class Packing { None, Gzip, Zlib };

    PackedOutput(AtomicFile& file, std::ofstream& stream, Packing packing)
        : mFile(file), mStream(stream), mPacks(packing != Packing::None) {
        std::memset(&mZlib, 0, sizeof mZlib);
        if (!mPacks) return;
        const int window = packing == Packing::Gzip ? 15 + 16 : 15;
        if (deflateInit2(&mZlib, kPackingLevel, Z_DEFLATED, window, 9, Z_DEFAULT_STRATEGY) !=
            Z_OK) {
            throw std::bad_alloc();
        }
    }
    ~PackedOutput() {
        if (mPacks) deflateEnd(&mZlib);
    }
    PackedOutput(const PackedOutput&) = delete;
    PackedOutput& operator=(const PackedOutput&) = delete;

    void put(std::string_view bytes) {
        if (!mPacks) return write(bytes);
        constexpr std::size_t kMost = std::size_t(1) << 30;
        while (!bytes.empty()) {
            const std::string_view some = bytes.substr(0, kMost);
            pack(some, Z_NO_FLUSH);
            bytes.remove_prefix(some.size());
        }
    }

    void finish() {
        if (mPacks) pack({}, Z_FINISH);
    }

  private:
    void pack(std::string_view bytes, int flush) {
        mZlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        mZlib.avail_in = static_cast<uInt>(bytes.size());
        do {
            mZlib.next_out = reinterpret_cast<Bytef*>(mBuffer.data());
            mZlib.avail_out = static_cast<uInt>(mBuffer.size());
            deflate(&mZlib, flush);
            write({mBuffer.data(), mBuffer.size() - mZlib.avail_out});
        } while (mZlib.avail_out == 0);
    }

    void write(std::string_view bytes) {
        if (mStream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return;
        throw Error(ErrorKind::Runtime,
                    "cannot write " + mFile.target().string() + ": " + std::strerror(errno));
    }

    AtomicFile& mFile;
    std::ofstream& mStream;
    bool mPacks;
    z_stream mZlib;
    std::string mBuffer = std::string(1 << 18, '\0');
};

void closeStream(AtomicFile& file, std::ofstream& stream) {
    stream.close();
    if (stream) return;
    throw Error(ErrorKind::Runtime,
                "cannot write " + file.target().string() + ": " + std::strerror(errno));
}

std::string headerText(ArrayFormat format, const ArrayHeaderRequest& request) {
    switch (format) {
        case ArrayFormat::Npy:
            return npyHeader(request);
        case ArrayFormat::Nrrd:
            return nrrdHeader(request);
        default:
            return metaImageHeader(request);
    }
}

void writeValues(VoxelSlices& slices, PackedOutput& output, Progress& progress) {
    const ProgressStage stage(progress, "writing", slices.slices());
    while (const int count = slices.together()) {
        progress.throwIfInterrupted();
        const std::vector<char>& bytes = slices.next();
        output.put({bytes.data(), bytes.size()});
        progress.advance(count);
    }
    output.finish();
}

}  // namespace

WrittenVoxels examineVoxels(const openvdb::FloatGrid& grid, const VoxelsToWrite& voxels,
                            Progress& progress) {
    VoxelSlices slices(grid, voxels, {0, 1, 2});
    const ProgressStage stage(progress, "examining", slices.slices());
    while (const int count = slices.together()) {
        progress.throwIfInterrupted();
        slices.next();
        progress.advance(count);
    }
    return slices.result();
}

WrittenVoxels writeArray(AtomicFile& file, AtomicFile* values, ArrayFormat format,
                         const openvdb::FloatGrid& grid, const ArrayWriteOptions& options,
                         Progress& progress) {
    const bool isNpy = format == ArrayFormat::Npy;
    if (isNpy && (options.compress || values)) {
        throw Error(ErrorKind::Usage,
                    "values of a .npy file are neither compressed nor in another file");
    }
    if (!grid.transform().isLinear()) {
        throw Error(ErrorKind::Input, "the transform of the grid '" + grid.getName() +
                                          "' is not linear; expected one that is");
    }
    VoxelSlices slices(grid, options.voxels, isNpy ? std::array{2, 1, 0} : std::array{0, 1, 2});
    ArrayHeaderRequest request;
    request.size = slices.size();
    request.type = options.voxels.type;
    request.toWorld = grid.transform().baseMap()->getAffineMap()->getMat4();
    request.toWorld.preTranslate(slices.box().min().asVec3d());
    request.place = placeMetadata(grid);
    request.compressed = options.compress;
    if (values) request.valuesFile = values->target().filename().string();
    const std::string header = headerText(format, request);

    using Packing = PackedOutput::Packing;
    const Packing packing = !options.compress             ? Packing::None
                            : format == ArrayFormat::Nrrd ? Packing::Gzip
                                                          : Packing::Zlib;
    std::ofstream stream = file.open();
    PackedOutput(file, stream, Packing::None).put(header);
    if (values) {
        closeStream(file, stream);
        stream = values->open();
    }
    AtomicFile& target = values ? *values : file;
    PackedOutput output(target, stream, packing);
    writeValues(slices, output, progress);
    closeStream(target, stream);
    return slices.result();
}

}  // namespace bandvox
