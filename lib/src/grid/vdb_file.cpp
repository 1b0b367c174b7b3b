#include "grid/guarded_reads.h"
#include "grid/leaf_writing.h"
#include "grid/sound_extent.h"
#include "grid/sound_transform.h"
#include "grid/vdb_archive.h"
#include "grid/watched_output.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Compression.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <istream>
#include <mutex>
#include <new>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

// Registers OpenVDB's types once; the library's users need not know of it.
void initializeOpenVdb() {
    static std::once_flag once;
    std::call_once(once, [] { openvdb::initialize(); });
}

std::uint32_t compressionFlags(VdbWriteOptions::Compression compression) {
    switch (compression) {
        case VdbWriteOptions::Compression::Blosc:
            return openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK;
        case VdbWriteOptions::Compression::Zip:
            return openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK;
        case VdbWriteOptions::Compression::None:
            break;
    }
    return openvdb::io::COMPRESS_NONE;
}

[[noreturn]] void failInput(const std::string& name, const std::string& why) {
    throw Error(ErrorKind::Input, name + ": " + why);
}

openvdb::GridPtrVec readGrids(const ByteSource& source, const std::string& name,
                              Progress& progress) {
    constexpr const char* kDamaged = "it is not a whole VDB file: it ends too early, or is damaged";
    initializeOpenVdb();
    const ProgressStage stage(progress, "reading", 0);
    GuardedBuffer buffer(source, progress);
    openvdb::GridPtrVec grids;
    try {
        // A stream that throws stops the reader at the end of a file that was cut short; its own
        // would go on with whatever is in memory.
        std::istream stream(&buffer);
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        grids = VdbArchive().read(stream, buffer);
    } catch (const Error&) {
        throw;
    } catch (const std::ios::failure&) {
        failInput(name, kDamaged);
    } catch (const std::bad_array_new_length&) {
        failInput(name, kDamaged);
    } catch (const std::bad_alloc&) {
        // No memory is enough for what a damaged file may ask for.
        if (buffer.guard().lastNumberIsTooLarge()) failInput(name, kDamaged);
        throw;
    } catch (const std::exception& error) {
        // A damaged file can put any number of bytes into OpenVDB's message.
        constexpr std::size_t kLongest = 200;
        failInput(name, "it is not a readable VDB file (" +
                            std::string(error.what()).substr(0, kLongest) + ")");
    }
    for (const openvdb::GridBase::Ptr& grid : grids) {
        const std::string fault = transformFault(grid->transform());
        if (!fault.empty()) failInput(name, "grid '" + grid->getName() + "' " + fault);
        const std::string extent = extentFault(*grid);
        if (!extent.empty()) failInput(name, "grid '" + grid->getName() + "' " + extent);
    }
    return grids;
}

// All that a stream holds.
std::string readBytes(std::istream& stream, const std::string& name, const Progress& progress) {
    std::string bytes;
    std::array<char, 65536> part;
    do {
        progress.throwIfInterrupted();
        stream.read(part.data(), part.size());
        bytes.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream);
    if (stream.bad()) {
        failInput(name, std::string("it cannot be read: ") + std::strerror(errno));
    }
    return bytes;
}

}  // namespace

void writeVdb(AtomicFile& file, const openvdb::GridCPtrVec& grids, const VdbWriteOptions& options,
              Progress& progress) {
    initializeOpenVdb();
    const ProgressStage stage(progress, "writing", 0);
    // Copies that share the trees carry the "save as half" flag without touching the caller's
    // grids.
    openvdb::GridCPtrVec saved;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        const auto copy = writtenByAllThreads(*grid);
        copy->setSaveFloatAsHalf(options.half);
        saved.push_back(copy);
    }
    VdbArchive archive;
    archive.setCompression(compressionFlags(options.compression));
    const auto failed = [&](const char* why) {
        return Error(ErrorKind::Runtime, "cannot write " + file.target().string() + ": " + why);
    };
    try {
        std::ofstream stream = file.open();
        stream.exceptions(std::ios::badbit | std::ios::failbit);
        WatchedOutput buffer(*stream.rdbuf(), file, progress);
        std::ostream watched(&buffer);
        watched.exceptions(std::ios::badbit | std::ios::failbit);
        archive.writeGrids(watched, saved, /*seekable=*/!file.inPlace());
        stream.close();
    } catch (const std::ios::failure&) {
        throw failed(std::strerror(errno));
    } catch (const openvdb::Exception& error) {
        throw failed(error.what());
    }
}

void writeVdb(const fs::path& path, const openvdb::GridCPtrVec& grids,
              const VdbWriteOptions& options, Progress& progress) {
    AtomicFile file(path);
    writeVdb(file, grids, options, progress);
    progress.throwIfInterrupted();
    file.commit();
}

openvdb::GridPtrVec readVdb(const fs::path& path, Progress& progress) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) failInput(path.string(), "there is no such file");
    if (fs::is_directory(path, ignored)) {
        failInput(path.string(), "it is a folder; expected a .vdb file");
    }
    if (!fs::is_regular_file(path, ignored)) {
        std::ifstream stream(path, std::ios::binary);
        if (!stream) failInput(path.string(), "it cannot be opened for reading");
        return readVdb(stream, path.string(), progress);
    }
    const auto size = static_cast<std::streamoff>(fs::file_size(path, ignored));
    if (size == 0) failInput(path.string(), "the file is empty");
    const FileBytes bytes(path, size);
    if (!bytes.isOpen()) failInput(path.string(), "it cannot be opened for reading");
    return readGrids(bytes, path.string(), progress);
}

openvdb::GridPtrVec readVdb(std::istream& stream, const std::string& name, Progress& progress) {
    std::string bytes = readBytes(stream, name, progress);
    if (bytes.empty()) failInput(name, "it is empty");
    return readGrids(MemoryBytes(std::move(bytes)), name, progress);
}

}  // namespace bandvox
