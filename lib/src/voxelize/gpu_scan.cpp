// N. Nakamura, Y. Inoue, K. Nishio, K. Kobori: "Fast Generation Method from Boundary Representation
// Model to Binary Voxel Data by Using GPU".

#include "voxelize/gpu_scan.h"

#include "voxelize/gl_context.h"
#include "voxelize/gl_objects.h"
#include "voxelize/gpu_shaders.h"
#include "voxelize/gpu_tiles.h"
#include "voxelize/lattice_points.h"
#include "voxelize/mesh_patches.h"

#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <array>
#include <utility>

namespace bandvox {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

constexpr int kPatchVertices = 6;
constexpr unsigned kPatchBinding = 0, kToggleBinding = 1;
constexpr int kWordBytes = sizeof(Rows);

// What does not change from tile to tile.
struct GpuRun {
    const Mesh& mesh;
    const VoxelLattice& samples;
    const GpuLimits& limits;
    Progress& progress;
    std::vector<LatticePoint> points;
    GlProgram program;
    GlVertexArray vertexArray;

    GpuRun(const Mesh& m, const VoxelLattice& lattice, GpuMethod method, const GpuLimits& l,
           Progress& p)
        : mesh(m),
          samples(lattice),
          limits(l),
          progress(p),
          points(roundToLattice(m, lattice)),
          program(patchVertexShader(), crossingFragmentShader(lattice.axis, method)) {
        program.use();
        checkGl("setting up the shaders");
    }
};

// The patches of a tile on the device, in parts that one call draws.
class PatchBuffers {
  public:
    PatchBuffers(const GpuRun& run, const CoordBBox& tile) {
        const std::vector<MeshPatch> patches =
            patchesOf(run.mesh, run.points, run.samples.axis, tile);
        const auto count = static_cast<std::int64_t>(patches.size());
        for (std::int64_t i = 0; i < count; i += run.limits.patches) {
            const std::int64_t part = std::min(run.limits.patches, count - i);
            mBuffers.emplace_back().allocate(part * static_cast<std::int64_t>(sizeof(MeshPatch)),
                                             patches.data() + i, GL_STATIC_DRAW);
            mCounts.push_back(static_cast<int>(part));
        }
    }

    void draw(const Progress& progress) const {
        for (std::size_t i = 0; i < mBuffers.size(); ++i) {
            progress.throwIfInterrupted();
            mBuffers[i].bind(kPatchBinding);
            glDrawArrays(GL_TRIANGLES, 0, kPatchVertices * mCounts[i]);
            // Keep a device from being busy for so long that it is taken for hung.
            if (i + 1 < mBuffers.size()) glFinish();
        }
    }

  private:
    std::vector<GlBuffer> mBuffers;
    std::vector<int> mCounts;
};

// The columns of a tile, and which of their rows are inside at the place that has been reached.
class TileColumns {
  public:
    explicit TileColumns(const GpuTile& tile)
        : mTile(tile), mColumns(tile.columnCount()), mInside(tile.columnCount()) {}

    // Goes on through the blocks [begin, end) along x. `words`: toggles, all of a column together.
    void addToggles(int begin, int end, const std::vector<Rows>& words) {
        const int first = mTile.lattice().firstBlock.x();
        const std::int64_t depth = std::int64_t(end - begin) * kBlockSide;
        parallelFor(mTile.columnCount(), [&](std::int64_t i) {
            const Rows* toggles = words.data() + i * depth;
            Rows inside = mInside[i];
            int done = first + begin;
            for (int x = first + begin; x < first + end; ++x, toggles += kBlockSide) {
                if (std::all_of(toggles, toggles + kBlockSide, [](Rows r) { return r == 0; })) {
                    continue;
                }
                mColumns[i].addUncrossed(done, x, inside);
                BlockRows rows;
                for (int k = 0; k < kBlockSide; ++k) rows[k] = inside ^= toggles[k];
                mColumns[i].add(x, rows);
                done = x + 1;
            }
            mColumns[i].addUncrossed(done, first + end, inside);
            mInside[i] = inside;
        });
    }

    // Adds a block along x. `rows`: those inside.
    void addBlock(int block, const std::vector<BlockRows>& rows) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            mColumns[i].add(mTile.lattice().firstBlock.x() + block, rows[i]);
        }
    }

    void setOpen(std::size_t column) { mColumns[column].isClosed = false; }
    void setInsideOut(std::size_t column) { mColumns[column].isInsideOut = true; }

    // All rows have to be outside at the end.
    ScannedTile finish() {
        for (std::size_t i = 0; i < mInside.size(); ++i) {
            if (mInside[i] != 0) setOpen(i);
        }
        const Coord first = mTile.lattice().firstBlock;
        return {first + mTile.begin(), first + mTile.end(), std::move(mColumns)};
    }

  private:
    const GpuTile& mTile;
    std::vector<BitColumn> mColumns;
    std::vector<Rows> mInside;
};

ScannedTile scanBits(GpuRun& run, const GpuTile& tile, int passDepth) {
    const GlTarget target(tile.height(), tile.width(), false);
    run.program.set("size", std::array{tile.height(), tile.width()});
    run.program.set("columns", std::array{tile.width() / kBlockSide});
    TileColumns columns(tile);
    GlBuffer buffer;
    std::vector<Rows> words;
    for (int begin = 0; begin < tile.depth(); begin += passDepth) {
        const int end = std::min(begin + passDepth, tile.depth());
        const int depth = (end - begin) * kBlockSide;
        words.resize(static_cast<std::size_t>(tile.columnCount()) * depth);
        const auto bytes = static_cast<std::int64_t>(words.size()) * kWordBytes;
        if (begin == 0) buffer.allocate(bytes, nullptr, GL_STREAM_READ);
        buffer.clear(bytes);
        buffer.bind(kToggleBinding);

        const CoordBBox samples = tile.samples(begin, end);
        run.program.set("first",
                        std::array{samples.min().x(), samples.min().y(), samples.min().z()});
        run.program.set("plane", std::array{samples.min().x()});
        run.program.set("depth", std::array{depth});
        PatchBuffers(run, samples).draw(run.progress);
        buffer.read(bytes, words.data());
        checkGl("drawing bits");
        columns.addToggles(begin, end, words);
        run.progress.advance();
    }
    return columns.finish();
}

// Looks through the winding numbers of a plane: calls visit(column, bit) for each pixel.
template <typename Visit>
void forEachPixel(const GpuTile& tile, const Visit& visit) {
    std::size_t pixel = 0;
    const int columns = tile.width() / kBlockSide;
    for (int z = 0; z < tile.width(); ++z) {
        for (int y = 0; y < tile.height(); ++y, ++pixel) {
            const auto column = static_cast<std::size_t>(y / kBlockSide) * columns + z / kBlockSide;
            visit(column, kBlockSide * (y % kBlockSide) + z % kBlockSide, pixel);
        }
    }
}

ScannedTile scanSlices(GpuRun& run, const GpuTile& tile) {
    const GlTarget target(tile.height(), tile.width(), true);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    const CoordBBox samples = tile.samples(0, tile.depth());
    const PatchBuffers patches(run, samples);
    run.program.set("size", std::array{tile.height(), tile.width()});
    run.program.set("first", std::array{samples.min().x(), samples.min().y(), samples.min().z()});
    std::vector<float> windings(static_cast<std::size_t>(tile.height()) * tile.width());
    const auto drawPlane = [&](int plane) {
        run.program.set("plane", std::array{plane});
        glClear(GL_COLOR_BUFFER_BIT);
        patches.draw(run.progress);
        glReadPixels(0, 0, tile.height(), tile.width(), GL_RED, GL_FLOAT, windings.data());
        checkGl("drawing a slice");
        run.progress.advance();
    };

    // Before the mesh nothing is inside.
    TileColumns columns(tile);
    drawPlane(-1);
    forEachPixel(tile, [&](std::size_t column, int, std::size_t pixel) {
        if (windings[pixel] != 0) columns.setOpen(column);
    });
    std::vector<BlockRows> rows(tile.columnCount());
    for (int block = 0; block < tile.depth(); ++block) {
        std::fill(rows.begin(), rows.end(), BlockRows{});
        for (int k = 0; k < kBlockSide; ++k) {
            drawPlane(block * kBlockSide + k);
            forEachPixel(tile, [&](std::size_t column, int bit, std::size_t pixel) {
                if (windings[pixel] > 0) rows[column][k] |= Rows(1) << bit;
                if (windings[pixel] < 0) columns.setInsideOut(column);
            });
        }
        columns.addBlock(block, rows);
    }
    return columns.finish();
}

// What the device allows.
GpuLimits limitsHere(const GpuLimits& limits) {
    std::array<GLint, 2> viewport{};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
    GLint width = 0, height = 0, block = 0, renderbuffer = 0;
    glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &width);
    glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &height);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderbuffer);
    glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    checkGl("asking for the device's limits");
    GpuLimits here = limits;
    here.side = std::min({limits.side, viewport[0], viewport[1], width, height, renderbuffer});
    here.bufferBytes = std::min<std::int64_t>(limits.bufferBytes, block);
    here.patches =
        std::min<std::int64_t>(limits.patches, block / static_cast<int>(sizeof(MeshPatch)));
    return here;
}

}  // namespace

std::string scanOnGpu(const Mesh& mesh, const VoxelLattice& samples, GpuMethod method,
                      const GpuLimits& limits, Progress& progress,
                      const std::function<void(const ScannedTile&)>& take) {
    requireGpuLattice(samples);
    const GlContext context;
    const GpuLimits here = limitsHere(limits);
    const GpuTiling tiling(samples, method, here);
    // The bits are held by the device, which may be this machine, and here.
    requireMemory(2.0 * static_cast<double>(tiling.bytes()), "the bits that the GPU makes");
    GpuRun run(mesh, samples, method, here, progress);
    const ProgressStage stage(progress, "voxelizing", tiling.steps());
    for (const GpuTile& tile : tiling.tiles()) {
        progress.throwIfInterrupted();
        take(method == GpuMethod::Bits ? scanBits(run, tile, tiling.passDepth())
                                       : scanSlices(run, tile));
    }
    return context.device();
}

}  // namespace bandvox
