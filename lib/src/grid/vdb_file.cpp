#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/Stream.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <istream>
#include <iterator>
#include <mutex>
#include <sstream>
#include <utility>

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

[[noreturn]] void failInput(const std::string& name, const std::string& why) {
    throw Error(ErrorKind::Input, name + ": " + why);
}

// A buffer for reading that hands out all that is asked for, or nothing. The lengths in a damaged
// file are any numbers, and OpenVDB reads that many bytes to where there is room for a few: with
// nothing behind the buffer's end, a length that is too long is an error and no overrun.
template <typename Buffer>
class WholeReads : public Buffer {
  public:
    explicit WholeReads(std::streamoff size) : mSize(size) {}

  protected:
    std::streamsize xsgetn(char* to, std::streamsize count) override {
        if (count > mSize - mPlace) return 0;
        const std::streamsize read = Buffer::xsgetn(to, count);
        mPlace += read;
        return read;
    }
    std::streampos seekoff(std::streamoff offset, std::ios::seekdir from,
                           std::ios::openmode which) override {
        return moved(Buffer::seekoff(offset, from, which));
    }
    std::streampos seekpos(std::streampos place, std::ios::openmode which) override {
        return moved(Buffer::seekpos(place, which));
    }

  private:
    std::streampos moved(std::streampos place) {
        if (place != std::streampos(-1)) mPlace = place;
        return place;
    }

    std::streamoff mSize;
    std::streamoff mPlace = 0;
};

openvdb::GridPtrVec readGrids(std::streambuf& buffer, const std::string& name) {
    initializeOpenVdb();
    try {
        // A stream that throws stops the reader at the end of a file that was cut short; its own
        // would go on with whatever is in memory.
        std::istream stream(&buffer);
        stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
        // Without delayed loading, so that damage is found now and not in the middle of the work.
        openvdb::io::Stream reader(stream, /*delayLoad=*/false);
        return *reader.getGrids();
    } catch (const std::ios::failure&) {
        failInput(name, "it is not a whole VDB file: it ends too early, or is damaged");
    } catch (const std::exception& error) {
        // A damaged file can put any number of bytes into OpenVDB's message.
        constexpr std::size_t kLongest = 200;
        failInput(name, "it is not a readable VDB file (" +
                            std::string(error.what()).substr(0, kLongest) + ")");
    }
}

}  // namespace

void writeVdb(AtomicFile& file, const openvdb::GridCPtrVec& grids, const VdbWriteOptions& options) {
    initializeOpenVdb();
    // Shallow copies carry the "save as half" flag without touching the caller's grids.
    openvdb::GridCPtrVec saved;
    for (const openvdb::GridBase::ConstPtr& grid : grids) {
        const auto copy = openvdb::ConstPtrCast<openvdb::GridBase>(grid->copyGrid());
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
        archive.write(stream, saved, /*seekable=*/!file.inPlace(), openvdb::MetaMap());
        stream.close();
    } catch (const std::ios::failure&) {
        throw failed(std::strerror(errno));
    } catch (const openvdb::Exception& error) {
        throw failed(error.what());
    }
}

void writeVdb(const fs::path& path, const openvdb::GridCPtrVec& grids,
              const VdbWriteOptions& options) {
    AtomicFile file(path);
    writeVdb(file, grids, options);
    file.commit();
}

openvdb::GridPtrVec readVdb(const fs::path& path) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) failInput(path.string(), "there is no such file");
    if (fs::is_directory(path, ignored)) {
        failInput(path.string(), "it is a folder; expected a .vdb file");
    }
    if (!fs::is_regular_file(path, ignored)) {
        std::ifstream stream(path, std::ios::binary);
        if (!stream) failInput(path.string(), "it cannot be opened for reading");
        return readVdb(stream, path.string());
    }
    const auto size = static_cast<std::streamoff>(fs::file_size(path, ignored));
    if (size == 0) failInput(path.string(), "the file is empty");
    WholeReads<std::filebuf> buffer(size);
    if (!buffer.open(path, std::ios::in | std::ios::binary)) {
        failInput(path.string(), "it cannot be opened for reading");
    }
    return readGrids(buffer, path.string());
}

openvdb::GridPtrVec readVdb(std::istream& stream, const std::string& name) {
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty()) failInput(name, "it is empty");
    const auto size = static_cast<std::streamoff>(bytes.size());
    WholeReads<std::stringbuf> buffer(size);
    buffer.str(std::move(bytes));
    return readGrids(buffer, name);
}

}  // namespace bandvox
