#include "core/worker_pool.h"
#include "grid/summary_values.h"
#include "spectral/fft.h"

#include <bandvox/core/parallel.h>
#include <bandvox/grid/volume_summary.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace bandvox {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kSide = RadialSpectrum::kBlockSide;
constexpr int kBlockLeaves = kSide / static_cast<int>(Leaf::DIM);

using Shells = std::array<double, RadialSpectrum::kShells>;

// Hann's window, whose values half a sample off are the same from both ends.
std::array<float, kSide> hannWindow() {
    std::array<float, kSide> window{};
    for (int i = 0; i < kSide; ++i) {
        const double sine = std::sin(std::numbers::pi * (i + 0.5) / kSide);
        window[i] = static_cast<float>(sine * sine);
    }
    return window;
}

// The shell of a frequency with these whole numbers of cycles per block.
int shellOf(int x, int y, int z) {
    const double squared =
        static_cast<double>(x) * x + static_cast<double>(y) * y + static_cast<double>(z) * z;
    return static_cast<int>(std::lround(std::sqrt(squared)));
}

// Cycles per block, with its sign.
int signedFrequency(int i) {
    return i <= kSide / 2 ? i : i - kSide;
}

// Measures one block at a time.
class BlockSpectrum {
  public:
    explicit BlockSpectrum(const openvdb::FloatGrid& grid)
        : mAccessor(grid.getConstAccessor()),
          mBackground(finiteBackground(grid)),
          mFft(RealFft3::get(kSide)),
          mData(mFft.allocate()),
          mWindow(hannWindow()) {}

    /// Mean power of the frequencies in each shell; `origin`: the block's first voxel, a leaf's.
    Shells measure(const openvdb::Coord& origin) {
        for (int x = 0; x < kBlockLeaves; ++x) {
            for (int y = 0; y < kBlockLeaves; ++y) {
                for (int z = 0; z < kBlockLeaves; ++z) copyLeaf(origin, openvdb::Coord(x, y, z));
            }
        }
        applyWindow();
        mFft.forward(mData.get());
        return averageShells();
    }

  private:
    float& at(int x, int y, int z) {
        return mData[(static_cast<std::size_t>(x) * mFft.yCount() + y) * mFft.zStride() + z];
    }

    void copyLeaf(const openvdb::Coord& origin, const openvdb::Coord& place) {
        constexpr int kDim = static_cast<int>(Leaf::DIM);
        const openvdb::Coord local(place.x() * kDim, place.y() * kDim, place.z() * kDim);
        const Leaf* leaf = mAccessor.probeConstLeaf(origin + local);
        const float constant = leaf ? 0 : finiteOr(mAccessor.getValue(origin + local), mBackground);
        const float* values = leaf ? leaf->buffer().data() : nullptr;
        for (int x = 0; x < kDim; ++x) {
            for (int y = 0; y < kDim; ++y) {
                float* row = &at(local.x() + x, local.y() + y, local.z());
                if (!values) {
                    std::fill_n(row, kDim, constant);
                    continue;
                }
                for (int z = 0; z < kDim; ++z) row[z] = finiteOr(*values++, mBackground);
            }
        }
    }

    // Takes the mean under the window away, then applies the window.
    void applyWindow() {
        double sum = 0, weights = 0;
        for (int x = 0; x < kSide; ++x) {
            for (int y = 0; y < kSide; ++y) {
                const double xy = static_cast<double>(mWindow[x]) * mWindow[y];
                const float* row = &at(x, y, 0);
                for (int z = 0; z < kSide; ++z) {
                    sum += xy * mWindow[z] * row[z];
                    weights += xy * mWindow[z];
                }
            }
        }
        const auto mean = static_cast<float>(sum / weights);
        for (int x = 0; x < kSide; ++x) {
            for (int y = 0; y < kSide; ++y) {
                const float xy = mWindow[x] * mWindow[y];
                float* row = &at(x, y, 0);
                for (int z = 0; z < kSide; ++z) row[z] = (row[z] - mean) * (xy * mWindow[z]);
            }
        }
    }

    Shells averageShells() {
        Shells power{}, counts{};
        for (int x = 0; x < kSide; ++x) {
            for (int y = 0; y < kSide; ++y) {
                const float* row = &at(x, y, 0);
                for (int z = 0; z <= kSide / 2; ++z) {
                    // Frequencies between the ends stand for their mirror images, too.
                    const double times = z == 0 || z == kSide / 2 ? 1 : 2;
                    const double re = row[2 * z], im = row[2 * z + 1];
                    const int shell = shellOf(signedFrequency(x), signedFrequency(y), z);
                    power[shell] += times * (re * re + im * im);
                    counts[shell] += times;
                }
            }
        }
        // White noise of variance v has v times the sum of the window's squares at each frequency.
        double squares = 0;
        for (const float w : mWindow) squares += static_cast<double>(w) * w;
        const double gain = squares * squares * squares;
        for (std::size_t shell = 0; shell < power.size(); ++shell) {
            power[shell] /= gain * std::max(1.0, counts[shell]);
        }
        return power;
    }

    openvdb::FloatGrid::ConstAccessor mAccessor;
    float mBackground;
    const RealFft3& mFft;
    FftBuffer mData;
    std::array<float, kSide> mWindow;
};

// First voxels of the blocks.
std::vector<openvdb::Coord> chooseBlocks(const openvdb::FloatGrid& grid, int most) {
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    const std::size_t count = std::min(leaves.size(), static_cast<std::size_t>(most));
    std::vector<openvdb::Coord> blocks;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t chosen = (2 * i + 1) * leaves.size() / (2 * count);
        blocks.push_back(leaves[chosen]->origin().offsetBy(-kSide / 2));
    }
    return blocks;
}

}  // namespace

RadialSpectrum radialSpectrum(const openvdb::FloatGrid& grid, int mostBlocks, Progress& progress) {
    if (mostBlocks < 1) {
        throw Error(ErrorKind::Usage,
                    "a spectrum of " + std::to_string(mostBlocks) + " blocks; expected at least 1");
    }
    requireActiveBox(grid);
    const std::vector<openvdb::Coord> blocks = chooseBlocks(grid, mostBlocks);
    RadialSpectrum spectrum;
    if (blocks.empty()) return spectrum;

    std::vector<Shells> found(blocks.size());
    WorkerPool<BlockSpectrum> pool([&grid] { return std::make_unique<BlockSpectrum>(grid); });
    const ProgressStage stage(progress, "spectrum", static_cast<std::int64_t>(blocks.size()));
    parallelFor(static_cast<std::int64_t>(blocks.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        auto worker = pool.take();
        found[i] = worker->measure(blocks[i]);
        pool.giveBack(std::move(worker));
        progress.advance();
    });

    // Add up in the order of the blocks, whichever thread measured them.
    spectrum.blocks = static_cast<int>(blocks.size());
    spectrum.power.assign(RadialSpectrum::kShells, 0);
    for (const Shells& shells : found) {
        for (std::size_t s = 0; s < shells.size(); ++s) spectrum.power[s] += shells[s];
    }
    for (double& power : spectrum.power) power /= spectrum.blocks;
    return spectrum;
}

}  // namespace bandvox
