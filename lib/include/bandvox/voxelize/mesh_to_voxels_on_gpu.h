#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/voxelize/voxels.h>

#include <string>

namespace bandvox {

/// How OpenGL makes voxels.
enum class GpuMethod {
    Bits,   ///< of all slices at once: each crossing toggles one bit, and all are read back once
    Slices  ///< plane by plane, as the paper does it: the mesh is drawn and read back for each
};

/// Does what meshToVoxels does, by OpenGL without a window, and voxel for voxel the same, for a
/// closed mesh around which no place is wound more than once, as uniteShells leaves it. Where
/// shells overlap, `GpuMethod::Bits` knows no more than whether the crossings of a row are odd.
///
/// N. Nakamura, Y. Inoue, K. Nishio, K. Kobori: "Fast Generation Method from Boundary
/// Representation Model to Binary Voxel Data by Using GPU".
///
/// Throws what meshToVoxels throws; Error(ErrorKind::Usage) too if there are more than 2^14 - 16
/// samples along a side; Error(ErrorKind::Runtime) if there is no EGL, no OpenGL of version 4.3
/// with whole numbers of 64 bits and floats of double precision, or the context gets lost;
/// Error(ErrorKind::Memory) if the device has not enough of it. It may be called from any thread,
/// and leaves a context that was current there current.
VoxelResult meshToVoxelsOnGpu(const MeshSource& source, const VoxelOptions& options = {},
                              GpuMethod method = GpuMethod::Bits,
                              Progress& progress = silentProgress());

/// What OpenGL there is to compute with.
struct OpenGlDevice {
    bool isHardware = false;  ///< a GPU that meshToVoxelsOnGpu can use, not a program like llvmpipe
    std::string description;  ///< its name; or, in half a sentence, why there is none
};

/// Looks for a GPU. Where there is none, this takes a few hundredths of a second.
OpenGlDevice findGpu();

}  // namespace bandvox
