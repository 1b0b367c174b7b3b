#pragma once

#include "grid/byte_source.h"

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <ios>
#include <span>

namespace bandvox {

/// Watches what OpenVDB reads from a .vdb file, and says where a length in it must be damage.
///
/// The lengths in a damaged file are any numbers, and OpenVDB 10 trusts some of them: a chunk of
/// voxels that is not compressed is read whatever its length, to where there is room for the
/// voxels alone. All reads pass through the stream's buffer, so that is where they are stopped.
///
/// Guarded against:
/// - reads beyond the end of the file: all that is asked for is handed out, or nothing;
/// - chunks of voxels, in nodes of 8³, 16³ and 32³, whose length is not that of the voxels they
///   are for, as the node's masks and the type of the grid tell it; of compressed chunks, lengths
///   beyond the end, and headers of Blosc that name another length than the chunk has, where it
///   would go on reading;
/// - room for text and metadata that is longer than the rest of the file.
///
/// Not guarded against:
/// - what is inside of a compressed chunk: Blosc and zlib check that themselves;
/// - the attributes of points, their pages, and the tables that OpenVDB keeps for loading later;
/// - what is read one character after another, as the values of a tree of text.
class ReadGuard {
  public:
    /// Of a file with this many bytes.
    explicit ReadGuard(std::streamoff size) : mSize(size) {}

    /// To be called when the header has been read: OpenVDB tells in the stream how it reads on.
    void watch(std::ios_base& stream) { mStream = &stream; }

    /// To be called around the reading of each grid.
    void beginGrid(const openvdb::GridBase& grid);
    void endGrid();

    bool mayRead(std::streamsize count) const { return count <= left(); }

    /// Takes note of what a read brought; false if that is damage.
    bool follow(std::span<const char> bytes);

    /// Takes note of a move. One over a chunk that is due ends it.
    void moveTo(std::streamoff place);

    /// A guard for a stream of its own that holds whole leaves of the tree being read, and has
    /// what OpenVDB told in the stream until now; it has this many bytes.
    ReadGuard forLeaves(std::ios_base& stream, std::streamoff size) const;

    /// True if the last thing read was a number, larger than the number of bytes that are left:
    /// for that many there will be no room.
    bool lastNumberIsTooLarge() const;

  private:
    enum class Stage {
        Between,  ///< anything may follow
        Mask,     ///< a node's masks have been read
        Extras,   ///< values and a mask that stand for the inactive voxels
        Length,   ///< of a chunk
        Blosc,    ///< a chunk that Blosc made
        Values,   ///< another chunk
    };

    std::streamoff left() const { return mSize - mPlace; }
    bool isSound(std::span<const char> bytes);
    bool isSoundOutsideOfTrees(std::span<const char> bytes);
    bool isSoundInTree(std::span<const char> bytes);
    void enterTree(const void* background);
    bool isMask(std::size_t size) const;
    bool isOldFormat() const;
    void followMask(std::span<const char> bytes);
    void followBesideMask(std::span<const char> bytes);
    void expectChunk(std::uint64_t values);
    bool isSoundLength(std::span<const char> bytes);
    void endChunk();

    std::ios_base* mStream = nullptr;
    std::streamoff mSize;
    std::streamoff mPlace = 0;

    struct Read {
        const char* to = nullptr;
        std::size_t size = 0;
        std::uint64_t number = 0;  ///< what was read, if it can be a number
    };
    Read mLast, mBeforeLast;
    int mTableReads = -1;  ///< since the name of a type of table was read; -1: none was

    // Of the grid.
    bool mHalf = false;              ///< reals are stored in half precision
    std::uint64_t mHalfBytes = 0;    ///< of such a value; 0 if it is not real
    bool mHoldsPoints = false;       ///< as a PointDataGrid does
    const void* mTree = nullptr;     ///< its background value, while its tree is read
    std::uint64_t mValueBytes = 0;   ///< in memory
    bool mNodesAreComplete = false;  ///< no node follows

    // Of the node.
    Stage mStage = Stage::Between;
    std::size_t mMaskBytes = 0;
    std::uint64_t mActive = 0;    ///< bits in the last mask
    std::uint64_t mChildren = 0;  ///< bits in the mask before
    int mExtras = 0;              ///< reads that stand before the chunk
    std::uint64_t mValues = 0;    ///< in the chunk
    std::uint64_t mChunkBytes = 0;
};

/// A stretch of a source that is read under a guard, until the work is to stop: then reading throws
/// Error(ErrorKind::Interrupted), as a stream does that is told to throw when it is bad.
class GuardedBuffer : public SourceBuffer {
  public:
    /// All of a source.
    GuardedBuffer(const ByteSource& source, const Progress& progress)
        : SourceBuffer(source, 0, source.size()), mGuard(source.size()), mProgress(progress) {}

    /// The bytes of another from `begin` up to `end`, which are whole leaves of the tree that its
    /// guard watches; they are read by `stream`.
    GuardedBuffer(const GuardedBuffer& whole, std::streamoff begin, std::streamoff end,
                  std::ios_base& stream)
        : SourceBuffer(whole.source(), begin, end),
          mGuard(whole.mGuard.forLeaves(stream, end - begin)),
          mProgress(whole.mProgress) {}

    ReadGuard& guard() { return mGuard; }

  protected:
    int_type underflow() override {
        mProgress.throwIfInterrupted();
        return SourceBuffer::underflow();
    }
    std::streamsize xsgetn(char* to, std::streamsize count) override {
        if (!mGuard.mayRead(count)) return 0;
        const std::streamsize read = SourceBuffer::xsgetn(to, count);
        return mGuard.follow({to, static_cast<std::size_t>(read)}) ? read : 0;
    }
    std::streampos seekoff(std::streamoff offset, std::ios::seekdir from,
                           std::ios::openmode which) override {
        return moved(SourceBuffer::seekoff(offset, from, which));
    }
    std::streampos seekpos(std::streampos place, std::ios::openmode which) override {
        return moved(SourceBuffer::seekpos(place, which));
    }

  private:
    std::streampos moved(std::streampos place) {
        if (place != std::streampos(-1)) mGuard.moveTo(place);
        return place;
    }

    ReadGuard mGuard;
    const Progress& mProgress;
};

}  // namespace bandvox
