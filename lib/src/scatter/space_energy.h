#pragma once

#include "scatter/space_net.h"

#include <array>
#include <span>
#include <vector>

namespace bandvox {

/// What squares of differences count: of the third, second and first ones of neighbouring control
/// points, as of the derivatives in |D³f|², |D²f|² and |Df|².
struct DifferenceWeights {
    double third = 0, second = 0, first = 0;

    /// For ∫ |D³f|² + 2α² |D²f|² + α⁴ |Df|², times `factor`, of cells of side `cell`.
    static DifferenceWeights ofTension(double tension, double cell, double factor);

    /// What a control point has on the diagonal if all its neighbours are there.
    double diagonal() const;
};

/// The energy of a sparse net of control points: the sum of the squares of their differences, each
/// of which counts if all its control points are there. No place has a say what the field does
/// beyond the net, so quadratics have no third differences, at its border either.
class SpaceEnergy {
  public:
    /// Keeps a reference to the net.
    SpaceEnergy(const SpaceNet& net, const DifferenceWeights& weights);

    /// y += E x.
    void addTo(std::span<const double> x, std::span<double> y) const;

    /// y += the diagonal of E.
    void addDiagonal(std::span<double> y) const;

  private:
    void addBorderBlock(std::size_t block, const double* cube, double* to, bool diagonal) const;

    const SpaceNet& mNet;
    DifferenceWeights mWeights;
    std::vector<char> mIsInside;  // of each block: all places as far as 3 away are there
};

}  // namespace bandvox
