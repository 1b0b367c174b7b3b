#pragma once

namespace bandvox {

/// The transfer function H(k) = exp(-(|k| / cutoff)^order), k in cycles per voxel.
///
/// Chiba, Aoki, Saito: "A Voxel Based Geometric Modeling" (1990), section 4, HE(u, v, w).
/// H(0) = 1, so filtering keeps the integral. Nyquist is 0.5.
struct ExponentialFilter {
    double order = 2;      ///< n ≥ 1; 2 is a Gaussian, larger ones are sharper and ring
    double cutoff = 0.16;  ///< k_c > 0, cycles per voxel

    /// H(k); k in cycles per voxel, any sign.
    double operator()(double k) const;

    /// H at the lattice's highest frequency: what the lattice cannot hold, relative to 1.
    double atNyquist() const { return (*this)(0.5); }
};

/// Throws Error(ErrorKind::Usage) unless order is in [1, 64] and cutoff in [0.01, 0.5].
void requireValid(const ExponentialFilter& filter);

/// The filtered density of a half-space, at `distance` voxels outside its face:
///     s(r) = 1/2 - ∫_0^∞ H(k) sin(2πkr) / (πk) dk,
/// 1/2 on the face, 1 deep inside (r < 0), 0 far outside.
double halfSpaceDensity(const ExponentialFilter& filter, double distance);

/// How far from a flat face, in voxels, its filtered density still differs from 0 or 1 by more
/// than `tolerance`. Throws Error(ErrorKind::Usage) if that is more than 256 voxels.
double filterReach(const ExponentialFilter& filter, double tolerance);

/// How far the filtered density of a half-space rises above 1 at most.
double filterOvershoot(const ExponentialFilter& filter);

}  // namespace bandvox
