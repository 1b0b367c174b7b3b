#include "core/words.h"
#include "grid/joint_reader.h"

#include <bandvox/compare/compare_grids.h>
#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/same_lattice.h>
#include <bandvox/resample/resample_grid.h>

#include <array>
#include <cmath>
#include <vector>

namespace bandvox {

namespace {

using ComparedLeaf = JointReader::Leaf;

// Sums over a cube of the lattice.
struct DifferenceSums {
    double voxels = 0, sum = 0, absolute = 0, square = 0;
    double maximum = -1;  // none yet
    openvdb::Coord at;
    double a = 0, b = 0;  // there

    void add(const openvdb::Coord& place, double valueA, double valueB, double count) {
        const double difference = valueB - valueA;
        voxels += count;
        sum += count * difference;
        absolute += count * std::abs(difference);
        square += count * difference * difference;
        note(place, valueA, valueB);
    }

    void add(const DifferenceSums& part) {
        voxels += part.voxels;
        sum += part.sum;
        absolute += part.absolute;
        square += part.square;
        if (part.maximum >= 0) note(part.at, part.a, part.b);
    }

  private:
    void note(const openvdb::Coord& place, double valueA, double valueB) {
        const double size = std::abs(valueB - valueA);
        if (size < maximum || (size == maximum && !(place < at))) return;
        maximum = size;
        at = place;
        a = valueA;
        b = valueB;
    }
};

void compareBlock(const JointReader& reader, const openvdb::Coord& origin, DifferenceSums& sums) {
    std::array<std::array<float, ComparedLeaf::SIZE>, 2> values{};
    std::array<ComparedLeaf::NodeMaskType, 2> active;
    for (std::size_t i = 0; i < 2; ++i) reader.readBlock(i, origin, values[i].data(), active[i]);
    // Block by block, so that small differences are not lost beside large sums.
    DifferenceSums block;
    for (openvdb::Index k = 0; k < ComparedLeaf::SIZE; ++k) {
        if (!active[0].isOn(k) && !active[1].isOn(k)) continue;
        block.add(origin + ComparedLeaf::offsetToLocalCoord(k), values[0][k], values[1][k], 1);
    }
    sums.add(block);
}

void compareCube(const JointReader& reader, const JointCube& cube, DifferenceSums& sums) {
    constexpr int kBlock = ComparedLeaf::DIM;
    const auto a = reader.constantIn(0, cube), b = reader.constantIn(1, cube);
    if (a && b) {
        const double count = std::pow(double(cube.side), 3);
        if (a->active || b->active) sums.add(cube.origin, a->value, b->value, count);
        return;
    }
    if (cube.side == kBlock) return compareBlock(reader, cube.origin, sums);
    openvdb::Coord at;
    const openvdb::Coord end = cube.origin.offsetBy(cube.side);
    for (at[0] = cube.origin[0]; at[0] < end[0]; at[0] += kBlock) {
        for (at[1] = cube.origin[1]; at[1] < end[1]; at[1] += kBlock) {
            for (at[2] = cube.origin[2]; at[2] < end[2]; at[2] += kBlock) {
                compareCube(reader, {at, kBlock}, sums);
            }
        }
    }
}

DifferenceSums compareJoint(const std::vector<JointGrid>& grids, Progress& progress) {
    const std::vector<JointCube> cubes = jointCubes(grids);
    std::vector<DifferenceSums> parts(cubes.size());
    const ProgressStage stage(progress, "comparing values",
                              static_cast<std::int64_t>(cubes.size()));
    parallelFor(static_cast<std::int64_t>(cubes.size()), [&](std::int64_t i) {
        progress.throwIfInterrupted();
        const auto at = static_cast<std::size_t>(i);
        compareCube(JointReader(grids), cubes[at], parts[at]);
        progress.advance();
    });
    DifferenceSums sums;
    for (const DifferenceSums& part : parts) sums.add(part);
    return sums;
}

}  // namespace

GridDifference compareGrids(const openvdb::FloatGrid::ConstPtr& a,
                            const openvdb::FloatGrid::ConstPtr& b,
                            const CompareGridsOptions& options, Progress& progress) {
    if (!a || !b) throw Error(ErrorKind::Usage, "comparing needs two grids, but one is missing");
    GridDifference result;
    openvdb::FloatGrid::ConstPtr second = b;
    auto offset = wholeVoxelOffset(a->transform(), b->transform());
    if (offset) {
        const bool isSame = *offset == openvdb::Coord(0);
        result.lattices = isSame ? ComparedLattices::Same : ComparedLattices::Shifted;
    } else {
        ResampleOptions reading;
        reading.filter.reset();
        reading.tolerance = options.tolerance;
        if (!a->transform().isLinear()) {
            throw Error(ErrorKind::Input, "the grid \"" + a->getName() +
                                              "\" has a transform of type " +
                                              a->transform().mapType() + "; expected a linear one");
        }
        second = resampleGrid(b, a->transform(), reading, progress).grid;
        result.lattices = ComparedLattices::Resampled;
        offset = openvdb::Coord(0);
    }

    const DifferenceSums sums =
        compareJoint({{a.get(), openvdb::Coord(0)}, {second.get(), *offset}}, progress);
    if (sums.voxels == 0) {
        throw Error(ErrorKind::Result, "there is nothing to compare: no voxel of the grids \"" +
                                           a->getName() + "\" and \"" + b->getName() +
                                           "\" is active");
    }
    result.voxels = static_cast<std::int64_t>(sums.voxels);
    result.maximum = sums.maximum;
    result.at = a->indexToWorld(sums.at);
    result.valueA = sums.a;
    result.valueB = sums.b;
    result.rms = std::sqrt(sums.square / sums.voxels);
    result.mean = sums.sum / sums.voxels;
    result.meanAbsolute = sums.absolute / sums.voxels;
    result.integralA = densityIntegral(*a);
    result.integralB = densityIntegral(*b);
    return result;
}

}  // namespace bandvox
