#pragma once

#include <cmath>

namespace bandvox {

/// The linear light of an sRGB-coded value in [0, 1], by IEC 61966-2-1.
inline double linearOfSrgb(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

}  // namespace bandvox
