#include "grid/vdb_archive.h"

#include "grid/leaf_reading.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {

namespace io = openvdb::io;

openvdb::GridPtrVec VdbArchive::read(std::istream& stream, GuardedBuffer& buffer) {
    ReadGuard& guard = buffer.guard();
    readHeader(stream);
    io::StreamMetadata::Ptr metadata(new io::StreamMetadata);
    io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);
    io::setVersion(stream, libraryVersion(), fileVersion());
    io::setDataCompression(stream, compression());
    guard.watch(stream);
    openvdb::MetaMap().readMeta(stream);

    openvdb::GridPtrVec grids;
    NamedGridMap named;
    std::vector<io::GridDescriptor> descriptors;
    const std::int32_t count = readGridCount(stream);
    for (std::int32_t i = 0; i < count; ++i) {
        io::GridDescriptor& descriptor = descriptors.emplace_back();
        grids.push_back(descriptor.read(stream));
        guard.beginGrid(*grids.back());
        readByAllThreads(grids.back(), buffer, [&](const openvdb::GridBase::Ptr& grid) {
            readGrid(grid, descriptor, stream);
        });
        guard.endGrid();
        named[descriptor.uniqueName()] = grids.back();
    }
    for (const auto& descriptor : descriptors) connectInstance(descriptor, named);
    return grids;
}

#if OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER < 13

// The way to write of these versions of OpenVDB compresses all leaves twice: first to note in the
// metadata how long each becomes, for readers that load leaves when they are asked for. Without the
// notes, which newer versions do not make, they look at the lengths in front of the leaves.

namespace {

// Names by which instances find each other: different ones, never empty.
std::vector<std::string> uniqueNames(const openvdb::GridCPtrVec& grids) {
    std::map<std::string, int> uses;
    for (const auto& grid : grids) ++uses[grid->getName()];
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const auto& grid : grids) {
        const std::string own = grid->getName();
        std::string name = own;
        for (int n = 0; name.empty() || (n == 0 && uses[own] > 1) || taken.count(name) > 0; ++n) {
            name = io::GridDescriptor::addSuffix(own, n);
        }
        taken.insert(name);
        names.push_back(name);
    }
    return names;
}

}  // namespace

void VdbArchive::writeGrids(std::ostream& stream, const openvdb::GridCPtrVec& grids,
                            bool seekable) const {
    // The stream points to these pointers.
    auto metadata = std::make_shared<io::StreamMetadata>();
    io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);
    io::setDataCompression(stream, compression());
    writeHeader(stream, seekable);
    openvdb::MetaMap().writeMeta(stream);
    const auto count = static_cast<std::int32_t>(grids.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof count);

    const std::vector<std::string> names = uniqueNames(grids);
    std::map<const openvdb::TreeBase*, std::string> written;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const openvdb::GridBase& grid = *grids[i];
        io::GridDescriptor descriptor(names[i], grid.type(), grid.saveFloatAsHalf());
        const auto [known, isNew] = written.emplace(&grid.baseTree(), names[i]);
        if (isNew) {
            writeWhole(descriptor, grid, metadata, stream, seekable);
        } else {
            descriptor.setInstanceParentName(known->second);
            writeGridInstance(descriptor, grids[i], stream, seekable);
        }
        // What suits a grid may be less than what suits all.
        io::setDataCompression(stream, compression());
    }
}

void VdbArchive::writeWhole(io::GridDescriptor& descriptor, const openvdb::GridBase& grid,
                            io::StreamMetadata::Ptr& ofFile, std::ostream& stream,
                            bool seekable) const {
    auto metadata = std::make_shared<io::StreamMetadata>(*ofFile);
    metadata->setHalfFloat(grid.saveFloatAsHalf());
    metadata->gridMetadata() = grid;
    io::setStreamMetadataPtr(stream, metadata, /*transfer=*/false);

    // The places are known, and written again, once the grid is.
    const auto place = [&] { return seekable ? static_cast<std::int64_t>(stream.tellp()) : 0; };
    descriptor.writeHeader(stream);
    const std::int64_t placeOfPlaces = place();
    descriptor.writeStreamPos(stream);
    descriptor.setGridPos(place());

    setGridCompression(stream, grid);
    const auto described = openvdb::ConstPtrCast<openvdb::GridBase>(grid.copyGrid());
    described->addStatsMetadata();
    described->insertMeta(
        openvdb::GridBase::META_FILE_COMPRESSION,
        openvdb::StringMetadata(io::compressionToString(io::getDataCompression(stream))));
    described->writeMeta(stream);
    grid.writeTransform(stream);
    grid.writeTopology(stream);
    descriptor.setBlockPos(place());
    grid.writeBuffers(stream);
    descriptor.setEndPos(place());

    if (seekable) {
        stream.seekp(placeOfPlaces, std::ios_base::beg);
        descriptor.writeStreamPos(stream);
        descriptor.seekToEnd(stream);
    }
    io::setStreamMetadataPtr(stream, ofFile, /*transfer=*/false);
}

#else

void VdbArchive::writeGrids(std::ostream& stream, const openvdb::GridCPtrVec& grids,
                            bool seekable) const {
    write(stream, grids, seekable, openvdb::MetaMap());
}

#endif

}  // namespace bandvox
