#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/Stream.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>

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

// openvdb::io::File does not notice a full disk. The same archive on a stream of our own does.
class VdbArchive : public openvdb::io::Archive {
  public:
    using openvdb::io::Archive::write;
};

[[noreturn]] void failInput(const fs::path& path, const std::string& why) {
    throw Error(ErrorKind::Input, path.string() + ": " + why);
}

}  // namespace

void writeVdb(const fs::path& path, const openvdb::GridCPtrVec& grids,
              const VdbWriteOptions& options) {
    initializeOpenVdb();
    // Shallow copies carry the "save as half" flag without touching the caller's grids.
    openvdb::GridCPtrVec saved;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid->copyGrid());
        copy->setSaveFloatAsHalf(options.half);
        saved.push_back(copy);
    }
    AtomicFile file(path);
    VdbArchive archive;
    archive.setCompression(compressionFlags(options.compression));
    try {
        std::ofstream stream;
        stream.exceptions(std::ios::badbit | std::ios::failbit);
        stream.open(file.temporary(), std::ios::binary);
        archive.write(stream, saved, /*seekable=*/true, openvdb::MetaMap());
        stream.close();
    } catch (const std::ios::failure&) {
        throw Error(ErrorKind::Runtime,
                    "cannot write " + path.string() + ": " + std::strerror(errno));
    } catch (const openvdb::Exception& error) {
        throw Error(ErrorKind::Runtime, "cannot write " + path.string() + ": " + error.what());
    }
    file.commit();
}

openvdb::GridPtrVec readVdb(const fs::path& path) {
    initializeOpenVdb();
    std::error_code ignored;
    if (!fs::exists(path, ignored)) failInput(path, "there is no such file");
    if (fs::is_directory(path, ignored)) failInput(path, "it is a folder; expected a .vdb file");
    if (fs::file_size(path, ignored) == 0) failInput(path, "the file is empty");
    if (!std::ifstream(path)) failInput(path, "it cannot be opened for reading");
    try {
        // A stream that throws stops the reader at the end of a file that was cut short; its own
        // would go on with whatever is in memory.
        std::ifstream stream(path, std::ios::binary);
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        // Without delayed loading, so that damage is found now and not in the middle of the work.
        openvdb::io::Stream reader(stream, /*delayLoad=*/false);
        return *reader.getGrids();
    } catch (const std::ios::failure&) {
        failInput(path, "it is not a whole VDB file: it ends too early");
    } catch (const std::exception& error) {
        // A damaged file can put any number of bytes into OpenVDB's message.
        constexpr std::size_t kLongest = 200;
        failInput(path, "it is not a readable VDB file (" +
                            std::string(error.what()).substr(0, kLongest) + ")");
    }
}

}  // namespace bandvox
