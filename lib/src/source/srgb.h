#pragma once

#include <cmath>

namespace bandvox {

/// The linear light of an sRGB-coded value in [0, 1], by IEC 61966-2-1.
inline double linearOfSrgb(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

/// The sRGB code, in [0, 1], of linear light; what is out of range is limited to it.
inline double srgbOfLinear(double light) {
    if (!(light > 0)) return 0;
    if (light >= 1) return 1;
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace bandvox
