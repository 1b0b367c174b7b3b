#pragma once

#include "source/bernstein_basis.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace bandvox {

/// A polynomial of two variables on [0, 1]² in Bernstein's basis, of degree m in u and n in v. It
/// lies between its smallest and its largest coefficient.
struct Bernstein2 {
    int m = 0, n = 0;
    std::vector<double> c{0.0};  ///< (m + 1) * (n + 1), [u][v]

    Bernstein2() = default;
    Bernstein2(int degreeU, int degreeV)
        : m(degreeU),
          n(degreeV),
          c(static_cast<std::size_t>(degreeU + 1) * static_cast<std::size_t>(degreeV + 1), 0.0) {}

    double& at(int i, int j) { return c[index(i, j)]; }
    double at(int i, int j) const { return c[index(i, j)]; }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(n + 1) +
               static_cast<std::size_t>(j);
    }

    double smallest() const;
    double largest() const;
    double largestMagnitude() const;
};

/// Of the same degrees.
Bernstein2 operator+(const Bernstein2& a, const Bernstein2& b);
Bernstein2 operator-(const Bernstein2& a, const Bernstein2& b);

/// The product, of the degrees' sums: exact but for rounding.
Bernstein2 operator*(const Bernstein2& a, const Bernstein2& b);

/// The partial derivatives, of a degree one less; 0 if that is 0.
Bernstein2 derivativeU(const Bernstein2& p);
Bernstein2 derivativeV(const Bernstein2& p);

/// The halves of a polynomial with u (or v) up to 1/2 and from there on, each on [0, 1]².
std::pair<Bernstein2, Bernstein2> splitU(const Bernstein2& p);
std::pair<Bernstein2, Bernstein2> splitV(const Bernstein2& p);

/// The quarters: (low u, low v), (low, high), (high, low), (high, high).
std::array<Bernstein2, 4> quarters(const Bernstein2& p);

/// p / u, p / (1 - u), p / v, p / (1 - v), for side 0 to 3, of a p that is 0 on that side.
Bernstein2 withoutFactor(const Bernstein2& p, int side);

/// The largest magnitude of coefficients on a side: 0 to 3 for u = 0, u = 1, v = 0, v = 1.
double sideMagnitude(const Bernstein2& p, int side);

/// A value and its gradient.
struct Gradient2 {
    double value = 0, du = 0, dv = 0;
};
Gradient2 evaluate(const Bernstein2& p, double u, double v);

/// Appends the roots in (a, b) of the polynomial on [a, b] with these coefficients, ascending;
/// as many, modulo 2, as the signs of its ends tell, where 0 counts as positive. Two roots closer
/// than 1e-12 (b - a) may be left out.
void appendRoots(std::vector<double> coefficients, double a, double b, std::vector<double>& roots);

}  // namespace bandvox
