#pragma once

#include <openvdb/Types.h>

#include <array>

namespace bandvox {

/// What a group of triangles looks like from afar: the integrals over them of n, of (x - c) n and
/// of (x - c)(x - c) n, with c the group's centre. World units.
///
/// G. Barill et al.: "Fast Winding Numbers for Soups and Clouds" (2018), section 3.
class WindingMoments {
  public:
    /// The winding number is Σ over terms of what is far: with R = centre - place and r = |R|,
    ///   4π w = (N·R + t) / r³ - (3 R·Q R + c·R) / r⁵ + S(R, R, R) / r⁷,
    /// where S is a cubic form. The numbers, in this order: N (3), t, Q's upper triangle (6), c
    /// (3), S by its monomials xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz (10).
    static constexpr int kCoefficients = 23;
    using Coefficients = std::array<float, kCoefficients>;

    /// Those of one triangle about `center`.
    static WindingMoments ofTriangle(const std::array<openvdb::Vec3d, 3>& corner,
                                     const openvdb::Vec3d& center);

    /// Adds those of another group, whose centre lies `shift` away from this one's.
    void add(const WindingMoments& other, const openvdb::Vec3d& shift);

    /// For lengths in units of `unit`, world units.
    Coefficients coefficients(double unit) const;

  private:
    openvdb::Vec3d mArea{0.0};                                      // N_k
    std::array<std::array<double, 3>, 3> mFirst{};                  // [i][k]
    std::array<std::array<std::array<double, 3>, 3>, 3> mSecond{};  // [i][j][k]
};

}  // namespace bandvox
