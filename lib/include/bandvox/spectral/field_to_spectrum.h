#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/source/field_source.h>
#include <bandvox/spectral/pruned_transform.h>
#include <bandvox/spectral/spectral_volume.h>

#include <optional>

namespace bandvox {

/// How a field becomes a SpectralVolume. The domain repeats, so a solid is filtered together with
/// its copies. The default domain leaves N/3 voxels between a solid and the next copy of it; what
/// the filter (6, 0.35) does then dies out below 1e-4 at N = 32 but is seen at N = 8, where a
/// wider domain helps.
struct SpectrumOptions {
    int resolution = 64;                   ///< N, voxels along the domain's side; even, 2 to 4096
    int samples = 512;                     ///< R, samples along the domain's side; N divides it
    ExponentialFilter filter;              ///< transfer function, cycles per voxel
    std::optional<SpectralDomain> domain;  ///< default: a cube around the field's box, half as
                                           ///< long again as its longest side
};

/// Algorithm I: takes the N low frequencies of R³ samples that are never all there. Samples are
/// asked for row by row along z; the rows of a plane are reduced to N frequencies, the plane
/// along y, and all planes along x. Working memory is R + RN numbers for each thread and RN² for
/// all (complex ones, of which the field's being real halves the number).
///
/// N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), section 5.1, figures
/// 11 and 12; the paper samples along x and reduces that axis first.
///
/// `count`, if given, receives what was multiplied. The result is the same for any number of
/// threads. Throws Error(ErrorKind::Usage) for a bad N, R, filter or domain,
/// Error(ErrorKind::Memory) before allocating, Error(ErrorKind::Interrupted).
template <typename Real = float>
BasicSpectralVolume<Real> fieldToSpectrum(const FieldSource& source, const SpectrumOptions& options,
                                          Progress& progress = silentProgress(),
                                          OperationCount* count = nullptr);

}  // namespace bandvox
