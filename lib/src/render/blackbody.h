#pragma once

#include <openvdb/Types.h>

namespace bandvox {

/// The colour of a body that is so hot, linear sRGB, relative to the luminance of one of 2000 K;
/// 0 below 500 K, and colours that sRGB does not hold are limited to those that it does.
///
/// M. Planck's law through the eye's response, for which C. Wyman, P. Sloan, P. Shirley: "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions" (2013) stand in.
openvdb::Vec3d blackbodyColor(double kelvin);

}  // namespace bandvox
