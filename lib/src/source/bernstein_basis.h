#pragma once

#include <array>
#include <cstddef>

namespace bandvox {

/// Bernstein's polynomials of a degree and their derivatives at one place.
class BernsteinBasis {
  public:
    static constexpr int kMost = 96;  ///< the highest degree
    BernsteinBasis(int degree, double t);
    double value(int i) const { return mValue[static_cast<std::size_t>(i)]; }
    double slope(int i) const { return mSlope[static_cast<std::size_t>(i)]; }

  private:
    // Those beyond the degree are left as they are.
    std::array<double, kMost + 1> mValue;
    std::array<double, kMost + 1> mSlope;
};

}  // namespace bandvox
