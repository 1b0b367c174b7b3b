#include "bandlimit/spooled_assembly.h"

#include "bandlimit/grid_assembly.h"
#include "grid/constant_leaf.h"
#include "grid/leaf_sums.h"
#include "grid/spooled_grid.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <openvdb/io/Compression.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

namespace bandvox {

namespace {

/// What a leaf without its values takes in the finished tree, with its share of the nodes above and
/// of the lists that writing needs, bytes.
constexpr double kBytesOfFinalLeaf = 340;

/// A vector that grows exists twice for a moment, the second time twice as large.
constexpr std::size_t kGrowing = 3;

bool isBeyondUnit(const DensityLeaf& leaf) {
    const float* values = leaf.buffer().data();
    return std::any_of(values, values + DensityLeaf::SIZE,
                       [](float value) { return value < 0 || value > 1; });
}

}  // namespace

void SpooledAssembly::KeptList::resize(std::size_t size) {
    while (mPieces.size() * kOfPiece < size) mPieces.emplace_back(kOfPiece);
    mSize = size;
}

SpooledAssembly::SpooledAssembly(const TileLayout& layout, const AssemblyOptions& options,
                                 bool rounds, const std::filesystem::path& target)
    : mLayout(layout),
      mOptions(options),
      mRounds(rounds),
      mFar(mLayout),
      mSpool(std::make_shared<LeafSpool>(target)) {}

double SpooledAssembly::memory() const {
    return static_cast<double>(mKept.size() * sizeof(Kept) +
                               kGrowing * mConstant.capacity() * sizeof(ConstantBlock) +
                               mPending.size() * kBytesOfLeaf);
}

double SpooledAssembly::finalMemory() const {
    return kBytesOfFinalLeaf * static_cast<double>(mKept.size()) +
           static_cast<double>(mConstant.capacity() * sizeof(ConstantBlock));
}

double SpooledAssembly::leastFinalMemory(double leaves) {
    constexpr double kSure = 0.75;  // of what is a fifth too high for flat surfaces
    return kSure * kBytesOfFinalLeaf * leaves;
}

// True if no column to come shares a block: the last one that does is that of its far corner.
bool SpooledAssembly::isComplete(const openvdb::Coord& block) const {
    const auto tileOf = [&](int axis) {
        const int last = block[axis] + DensityLeaf::DIM - 1 - mLayout.origin[axis];
        return std::min(last / mLayout.interior, mLayout.count[axis] - 1);
    };
    return static_cast<std::int64_t>(tileOf(1)) * mLayout.count.z() + tileOf(2) < mNext;
}

LeafList SpooledAssembly::takeComplete() {
    const auto border = std::partition(mPending.begin(), mPending.end(), [&](const auto& leaf) {
        return !isComplete(leaf->origin());
    });
    LeafList complete(std::make_move_iterator(border), std::make_move_iterator(mPending.end()));
    mPending.erase(border, mPending.end());
    return complete;
}

void SpooledAssembly::add(std::vector<ColumnBlocks> columns) {
    LeafList leaves;
    for (ColumnBlocks& column : columns) {
        std::move(column.inner.begin(), column.inner.end(), std::back_inserter(leaves));
        std::move(column.border.begin(), column.border.end(), std::back_inserter(mPending));
        mConstant.insert(mConstant.end(), column.constant.begin(), column.constant.end());
    }
    mFar.take(mNext, columns);
    mNext += static_cast<std::int64_t>(columns.size());
    columns.clear();
    finishLeaves(leaves, mOptions);
    keep(std::move(leaves));
    JoinedBlocks joined = joinPieces(takeComplete(), mFar, mOptions);
    std::copy_if(joined.constant.begin(), joined.constant.end(), std::back_inserter(mConstant),
                 [](const ConstantBlock& block) { return block.value != 0; });
    keep(std::move(joined.leaves));
}

// Rounds to 16 bits, and makes tiles of what differed by less than these hold. `sums`: of active
// values before.
void SpooledAssembly::round(LeafList& leaves, std::vector<double>& sums) {
    std::mutex mutex;
    forEachChunkOfLeaves(leaves.size(), [&](std::size_t begin, std::size_t end) {
        double change = 0, inside = 0;
        for (std::size_t i = begin; i < end; ++i) {
            float* values = leaves[i]->buffer().data();
            for (openvdb::Index v = 0; v < DensityLeaf::SIZE; ++v) {
                const float rounded = openvdb::io::truncateRealToHalf(values[v]);
                const double difference = std::abs(rounded - values[v]);
                change = std::max(change, difference);
                if (values[v] >= 0 && values[v] <= 1) inside = std::max(inside, difference);
                values[v] = rounded;
            }
        }
        const std::scoped_lock lock(mutex);
        mChange = std::max(mChange, change);
        mChangeInside = std::max(mChangeInside, inside);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        if (isConstantLeaf(*leaves[i])) {
            const float value = leaves[i]->buffer().data()[0];
            mConstant.push_back({leaves[i]->origin(), value});
            mLost += sums[i] - static_cast<double>(value) * DensityLeaf::SIZE;
            continue;
        }
        sums[kept] = sums[i];
        leaves[kept++] = std::move(leaves[i]);
    }
    leaves.resize(kept);
    sums.resize(kept);
}

// Moves the values of leaves into the file.
void SpooledAssembly::keep(LeafList leaves) {
    std::erase(leaves, nullptr);
    std::vector<double> sums(leaves.size());
    forEachChunkOfLeaves(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) sums[i] = sumOfActive(*leaves[i]);
    });
    if (mRounds) round(leaves, sums);
    const std::size_t first = mKept.size();
    if (first + leaves.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorKind::Memory,
                    "the grid has more than 2^32 leaf nodes; take larger voxels");
    }
    mKept.resize(first + leaves.size());
    forEachChunkOfLeaves(leaves.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const DensityLeaf& leaf = *leaves[i];
            mKept[first + i] = {leaf.origin(), isBeyondUnit(leaf), leaf.getValueMask(), sums[i],
                                mRounds ? sumOfActive(leaf) : sums[i]};
        }
        mSpool->write(static_cast<std::uint32_t>(first + begin),
                      std::span(leaves).subspan(begin, end - begin));
        for (std::size_t i = begin; i < end; ++i) leaves[i].reset();
    });
}

// Limits what is beyond [0, 1], in the file. Rounding first and limiting then is the same as the
// other way round.
void SpooledAssembly::limitKept() {
    std::vector<std::uint8_t> isConstant(mKept.size());
    forEachChunkOfLeaves(mKept.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Kept& kept = mKept[i];
            if (!kept.isBeyond) continue;
            const auto number = static_cast<std::uint32_t>(i);
            LeafList leaf;
            leaf.push_back(std::make_unique<DensityLeaf>(kept.origin));
            mSpool->read(number, *leaf[0]);
            limitValues(*leaf[0]);
            activateNonzero(*leaf[0]);
            kept.active = leaf[0]->getValueMask();
            kept.sum = kept.storedSum = sumOfActive(*leaf[0]);
            mSpool->write(number, leaf);
            isConstant[i] = mRounds && isConstantLeaf(*leaf[0]) ? 1 : 0;
        }
    });
    for (std::size_t i = 0; i < mKept.size(); ++i) {
        if (isConstant[i] == 0) continue;
        // All its values are positive numbers up to 1 that have become 1.
        mConstant.push_back({mKept[i].origin, 1});
        mKept[i].active.setOff();
    }
    mChange = mChangeInside;
}

SpooledAssembly::Grid SpooledAssembly::finish(bool limit) {
    if (limit && !mOptions.clamp) limitKept();
    auto tree = std::make_shared<openvdb::FloatTree>(0.0F);
    auto grid = std::make_shared<SpooledGrid>(tree, mSpool);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(mLayout.voxelSize));
    addTiles(mFar, mConstant, limit || mOptions.clamp, *tree);
    mConstant = {};
    // Where there are leaves nothing can be pruned, so it may be done before they come.
    openvdb::tools::pruneTiles(*tree, 0.0F, /*threaded=*/false);
    if (mRounds) mChange = std::max(mChange, roundToHalf(*grid));

    // Put leaves without values into the tree, and give back what was known of them.
    std::vector<double> sums, storedSums;
    std::uint32_t number = 0;
    {
        openvdb::tree::ValueAccessor<openvdb::FloatTree, false> accessor(*tree);
        const std::size_t count = mKept.size();
        sums.reserve(count);
        if (mRounds) storedSums.reserve(count);
        for (std::vector<Kept>& piece : mKept.take()) {
            for (std::size_t i = 0; i < piece.size() && number < count; ++i, ++number) {
                const Kept& kept = piece[i];
                sums.push_back(kept.sum);
                if (mRounds) storedSums.push_back(kept.storedSum);
                if (kept.active.isOff()) continue;
                auto leaf = std::make_unique<DensityLeaf>(openvdb::PartialCreate(), kept.origin,
                                                          0.0F, false);
                leaf->setValueMask(kept.active);
                leaf->setTransientData(number);
                accessor.addLeaf(leaf.release());
            }
            std::vector<Kept>().swap(piece);
        }
    }

    // Sum up in the tree's order.
    std::vector<const DensityLeaf*> leaves;
    tree->getNodes(leaves);
    const auto integrate = [&](const std::vector<double>& ofNumber) {
        std::vector<double> ordered;
        ordered.reserve(leaves.size());
        for (const DensityLeaf* leaf : leaves) ordered.push_back(ofNumber[leaf->transientData()]);
        return integralOf(*grid, ordered);
    };
    if (!mRounds) {
        const double integral = integrate(sums);
        return {grid, integral, integral, 0};
    }
    const double lost = mLost * grid->transform().voxelVolume();
    return {grid, integrate(storedSums), integrate(sums) + lost, mChange};
}

}  // namespace bandvox
