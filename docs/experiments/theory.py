"""The closed forms that README.md compares its measurements with; equations as numbered there."""

import math

import numpy as np


def face_slope(order, cutoff):
    """s'(0), the slope of a flat face's density on the face, per voxel."""
    return 2 * cutoff * math.gamma(1 + 1 / order)


def pole_error(order, cutoff, radius, samples):
    """The error on the pole of a sphere that lies on a sample (README.md, equation 2)."""
    q = np.linspace(0, 1.5 * cutoff * 2 ** (2 / order), 4001)
    along = np.linspace(0, q[-1], 1201)
    k = np.hypot(q[:, None], along[None, :])
    slices = 2 * np.trapz(np.exp(-(k / cutoff) ** order), along, axis=1)
    error = 0
    terms = 60
    for j in range(1, terms + 1):
        chirp = radius / (j * samples)
        integral = np.trapz(2 * np.pi * q * slices * np.exp(1j * np.pi * chirp * q ** 2), q)
        error += (chirp * integral).real / (np.pi * j * samples)
    # The terms that are left fall as 1/j², the chirp being nothing for them.
    return error + pole_limit(order, cutoff, radius, samples) * 6 / math.pi ** 2 / (terms + 0.5)


def pole_limit(order, cutoff, radius, samples):
    """The same for many samples (equation 3)."""
    center = 4 * math.pi * cutoff ** 3 * math.gamma(3 / order) / order
    return math.pi / 6 * radius * center / samples ** 2


def edge_width(order, cutoff):
    """Voxels between the densities 5 and 95 % of a flat face, by integrating its slope."""
    r = np.linspace(0, 8, 4001)
    k = np.linspace(0, 4 * cutoff, 4001)
    slope = 2 * np.trapz(np.exp(-(k / cutoff) ** order) * np.cos(2 * np.pi * np.outer(r, k)), k,
                         axis=1)
    density = 0.5 - np.concatenate(([0], np.cumsum((slope[1:] + slope[:-1]) / 2))) * r[1]
    return 2 * r[np.argmax(density < 0.05)]


def rms_limit(order, cutoff, samples, lattice_sum):
    """RMS error of a solid with normals in all directions (equation 4)."""
    energy = (4 * math.pi * cutoff ** 3 * math.gamma(3 / order)
              / (order * 2 ** (3 / order)))
    return np.sqrt(lattice_sum / (8 * math.pi ** 3) * energy
                   / edge_width(order, cutoff)) / samples ** 2


# Σ 1/|m|⁴ over whole m ≠ 0, and the same with the six poles' errors added in phase.
SUM_APART = 16.5323
SUM_IN_PHASE = SUM_APART - 6 * math.pi ** 4 / 90 + 12 * (math.pi ** 2 / 6) ** 2


def curvature_constant(order, cutoff):
    """The surface at 0.5 of a ball lies this over its radius inside, voxels² (equation 6)."""
    return (math.gamma(1 - 1 / order) / math.gamma(1 + 1 / order)
            / (4 * math.pi ** 2 * cutoff ** 2))
