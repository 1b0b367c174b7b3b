#pragma once

#include "source/patch.h"

#include <vector>

namespace bandvox {

/// A point of a rule on what is left of a cell: parameters and weight, of which those of the whole
/// cell add up to its area in parameters.
struct TrimmedPoint {
    double u, v, weight;
};

/// What is left of a patch where not all of it counts.
class CellTrim {
  public:
    virtual ~CellTrim() = default;

    /// What is left of a cell.
    enum class Share { None, All, Unknown };

    /// Unknown if the cell may be cut.
    virtual Share share(const Patch& patch, const ParameterCell& cell) const = 0;

    /// Quadrature points on what is left of a cell, which is no longer than a voxel.
    virtual std::vector<TrimmedPoint> rule(const Patch& patch, const ParameterCell& cell) const = 0;
};

}  // namespace bandvox
