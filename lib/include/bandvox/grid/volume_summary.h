#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <vector>

// What a page about a grid shows of it: a small dense copy, a histogram and a spectrum. Voxels that
// are not finite count as background, or as 0 if that is not finite either. Results are the same
// for any number of threads. All of it throws Error(ErrorKind::Result) if nothing is active, and
// Error(ErrorKind::Interrupted).
namespace bandvox {

/// A box of samples of a grid, at most so many a side.
///
/// Each sample is the mean of the voxels around it under a tent whose half width is the distance of
/// two samples: its transfer function, sinc², has its zeros where the lattice of samples cannot
/// tell a wave from a constant. Where that distance is one voxel, samples are the voxels. Inactive
/// voxels count with their values.
struct VolumeTexture {
    std::array<int, 3> size{};         ///< samples along the grid's x, y and z
    std::vector<float> values;         ///< size[0]·size[1]·size[2], x fastest
    openvdb::Vec3d first{0, 0, 0};     ///< place of the first sample, index space
    openvdb::Vec3d spacing{1, 1, 1};   ///< between samples, voxels, ≥ 1 along each axis
    float low = 0, high = 0;           ///< range of `values`
    std::int64_t notFiniteValues = 0;  ///< voxels that are not finite; tiles count as one

    float at(int x, int y, int z) const {
        return values[(static_cast<std::size_t>(z) * size[1] + y) * size[0] + x];
    }
};

/// Covers the box of active voxels, and one sample more on every side, with samples that are
/// equally far from each other in the world along all axes, unless that is less than a voxel.
/// `longest`: samples along the longest side, in [4, 1024]; fewer if the grid has fewer voxels.
/// Throws Error(ErrorKind::Usage) if it is not, Error(ErrorKind::Memory).
VolumeTexture gridToTexture(const openvdb::FloatGrid& grid, int longest,
                            Progress& progress = silentProgress());

/// How often values occur in the box of active voxels.
struct ValueHistogram {
    static constexpr int kBins = 128;
    double low = 0, high = 0;  ///< of all values in the box; bins divide this range equally
    std::array<double, kBins> active{};    ///< voxels that are active
    std::array<double, kBins> inactive{};  ///< voxels that are not, background included
};

/// Counts every voxel of the box of active voxels. The last bin includes `high`; if all values are
/// the same they are in the first.
ValueHistogram valueHistogram(const openvdb::FloatGrid& grid,
                              Progress& progress = silentProgress());

/// How a grid's power is spread over frequencies, in all directions together.
struct RadialSpectrum {
    /// Samples along the side of a block.
    static constexpr int kBlockSide = 64;
    /// Shell s holds frequencies that round to s / kBlockSide cycles per voxel; up to 32 are
    /// whole, those after it hold the corners beyond Nyquist of the axes.
    static constexpr int kShells = 56;
    /// Mean power of a frequency in each shell, value². White noise of variance v has v in all of
    /// them but the first two, which lose what the blocks' means take away. Empty if `blocks` is 0.
    std::vector<double> power;
    int blocks = 0;  ///< that were averaged

    /// Cycles per voxel.
    static double frequency(int shell) { return static_cast<double>(shell) / kBlockSide; }
};

/// Estimates the spectrum by Welch's method, P. Welch: "The Use of Fast Fourier Transform for the
/// Estimation of Power Spectra" (1967): the mean over blocks of 64³ voxels, under a Hann window
/// along each axis and without their means. The blocks lie around leaf nodes, `mostBlocks` ≥ 1 of
/// them, evenly chosen in the tree's order; a grid without leaf nodes has none.
/// Throws Error(ErrorKind::Usage) if mostBlocks < 1.
RadialSpectrum radialSpectrum(const openvdb::FloatGrid& grid, int mostBlocks = 200,
                              Progress& progress = silentProgress());

}  // namespace bandvox
