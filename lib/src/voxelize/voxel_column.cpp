#include "voxelize/voxel_column.h"

#include <algorithm>
#include <array>
#include <bit>

namespace bandvox {

namespace {

// Swaps rows and columns of a matrix of 8 × 8 bits, a row a byte: first single bits, then squares
// of 2 × 2 and 4 × 4.
Rows transposed(Rows m) {
    const auto swap = [&m](int distance, Rows mask) {
        const Rows t = (m ^ (m >> distance)) & mask;
        m ^= t ^ (t << distance);
    };
    swap(7, 0x00aa00aa00aa00aa);
    swap(14, 0x0000cccc0000cccc);
    swap(28, 0x00000000f0f0f0f0);
    return m;
}

// Turns rows of a scan to those of the grid, whose words are places along x.
BlockRows rowsInGrid(const BlockRows& rows, ScanAxis axis) {
    if (axis == ScanAxis::X) return rows;
    // What the words count goes to the bytes, what the bytes count to the words.
    BlockRows result{};
    for (int word = 0; word < kBlockSide; ++word) {
        for (int byte = 0; byte < kBlockSide; ++byte) {
            result[byte] |= (rows[word] >> (8 * byte) & 255) << (8 * word);
        }
    }
    // Along z, the bytes are now z and the bits y.
    if (axis == ScanAxis::Z)
        std::transform(result.begin(), result.end(), result.begin(), transposed);
    return result;
}

std::unique_ptr<VoxelLeaf> binaryLeaf(const openvdb::Coord& block, const BlockRows& rows) {
    auto leaf = std::make_unique<VoxelLeaf>(block << kBlockLog2, 0.0F, false);
    float* values = leaf->buffer().data();
    VoxelLeaf::NodeMaskType active;
    for (int x = 0; x < kBlockSide; ++x) {
        active.getWord<Rows>(x) = rows[x];
        for (Rows rest = rows[x]; rest != 0; rest &= rest - 1) {
            values[x * kBlockSide * kBlockSide + std::countr_zero(rest)] = 1;
        }
    }
    leaf->setValueMask(active);
    return leaf;
}

// Makes voxels that are 0 or 1 of bits.
ColumnVoxels binaryColumn(const VoxelLattice& lattice, openvdb::Coord block,
                          const BitColumn& bits) {
    ColumnVoxels column;
    for (const BitBlock& part : bits.blocks) {
        for (const Rows word : part.rows) column.voxels += std::popcount(word);
        block.x() = part.x;
        column.leaves.push_back(
            binaryLeaf(lattice.inGrid(block), rowsInGrid(part.rows, lattice.axis)));
    }
    for (const SolidRun& run : bits.solid) {
        column.voxels += std::int64_t(run.end - run.begin) * VoxelLeaf::SIZE;
    }
    column.eighths = kSubSamples * column.voxels;
    column.solid = bits.solid;
    return column;
}

BitColumn aboveThreshold(const SubSampleColumns& samples, int threshold) {
    BitColumn bits;
    countSubSamples(
        samples, [&](const SolidRun& run) { bits.addUncrossed(run.begin, run.end, kAllRows); },
        [&](int x, const BlockCounts& counts) {
            BlockRows rows{};
            for (std::size_t i = 0; i < counts.size(); ++i) {
                rows[i >> 6] |= Rows(counts[i] >= threshold) << (i & 63);
            }
            bits.add(x, rows);
        });
    return bits;
}

// Makes voxels whose values are the share of their sub-samples inside.
ColumnVoxels fractionColumn(const VoxelLattice& lattice, openvdb::Coord block,
                            const SubSampleColumns& samples) {
    const std::array<int, 3> order = scanOrder(lattice.axis);
    std::array<int, 3> stride{};  // in a leaf node, along the axes of the scan
    for (int i = 0; i < 3; ++i) stride[i] = 1 << (kBlockLog2 * (2 - order[i]));
    ColumnVoxels column;
    const auto addSolid = [&](const SolidRun& run) {
        if (column.solid.empty() || column.solid.back().end != run.begin) {
            column.solid.push_back(run);
        }
        column.solid.back().end = run.end;
        column.voxels += std::int64_t(run.end - run.begin) * VoxelLeaf::SIZE;
        column.eighths += std::int64_t(run.end - run.begin) * VoxelLeaf::SIZE * kSubSamples;
    };
    countSubSamples(samples, addSolid, [&](int x, const BlockCounts& counts) {
        if (std::all_of(counts.begin(), counts.end(), [](int n) { return n == kSubSamples; })) {
            return addSolid({x, x + 1});
        }
        block.x() = x;
        auto leaf = std::make_unique<VoxelLeaf>(lattice.inGrid(block) << kBlockLog2, 0.0F, false);
        float* values = leaf->buffer().data();
        for (int i = 0; i < static_cast<int>(counts.size()); ++i) {
            if (counts[i] == 0) continue;
            const int place = (i >> 6) * stride[0] + (i >> 3 & 7) * stride[1] + (i & 7) * stride[2];
            values[place] = static_cast<float>(counts[i]) / kSubSamples;
            leaf->setValueOn(place);
            ++column.voxels;
            column.eighths += counts[i];
        }
        column.leaves.push_back(std::move(leaf));
    });
    return column;
}

}  // namespace

VoxelLattice sampleLattice(const VoxelLattice& lattice, const VoxelOptions& options) {
    return options.subSamples() ? subSampleLattice(lattice) : lattice;
}

ColumnVoxels makeColumn(const VoxelLattice& lattice, const VoxelOptions& options,
                        const openvdb::Coord& block, const SampledColumns& samples) {
    if (!options.subSamples()) {
        const BitColumn bits = samples(block);
        ColumnVoxels column = binaryColumn(lattice, block, bits);
        column.isClosed = bits.isClosed;
        column.isInsideOut = bits.isInsideOut;
        return column;
    }
    SubSampleColumns parts;
    for (int i = 0; i < 4; ++i) {
        parts[i] = samples((block << 1) + openvdb::Coord(0, i >> 1, i & 1));
    }
    ColumnVoxels column =
        options.fraction ? fractionColumn(lattice, block, parts)
                         : binaryColumn(lattice, block, aboveThreshold(parts, options.threshold));
    for (const BitColumn& part : parts) {
        column.isClosed = column.isClosed && part.isClosed;
        column.isInsideOut = column.isInsideOut || part.isInsideOut;
    }
    return column;
}

}  // namespace bandvox
