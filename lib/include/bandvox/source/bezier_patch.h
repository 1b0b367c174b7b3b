#pragma once

#include <bandvox/source/face_topology.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace bandvox {

/// A tensor-product Bézier patch, rational or not: the point at (u, v) in [0, 1]² is
/// Σ B_i(u) B_j(v) (wx, wy, wz) / Σ B_i(u) B_j(v) w.
struct BezierPatch {
    /// The highest degree that readers accept: beyond it binomial coefficients cost digits.
    static constexpr int kHighestDegree = 25;

    int degreeU = 0, degreeV = 0;  ///< 1 to kHighestDegree
    /// (degreeU + 1) * (degreeV + 1) points (w x, w y, w z, w), [u][v], world units; w > 0.
    std::vector<std::array<double, 4>> control;
    int object = 0;  ///< which of a model's objects it belongs to

    const std::array<double, 4>& at(int i, int j) const { return control[index(i, j)]; }
    std::array<double, 4>& at(int i, int j) { return control[index(i, j)]; }

    /// Where the control point i along u, j along v is.
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(degreeV + 1) +
               static_cast<std::size_t>(j);
    }
};

/// A point of a patch with its derivatives by the parameters, world units.
struct PatchJet {
    std::array<double, 3> position, du, dv, duu, duv, dvv;
};

/// The point at (u, v), each from 0 to 1, and its first and second derivatives.
PatchJet evaluate(const BezierPatch& patch, double u, double v);

/// The part of a patch with u from u0 to u1 and v from v0 to v1, as a patch of its own.
BezierPatch restricted(const BezierPatch& patch, double u0, double u1, double v0, double v1);

/// Patches, and the names of the objects that they belong to.
struct PatchModel {
    std::vector<BezierPatch> patches;
    std::vector<std::string> objects;   ///< at least one if there are patches
    std::vector<std::string> warnings;  ///< what a reader left out
    FaceTopology topology;              ///< of patches that are trimmed faces; else empty

    /// Adds the patches, objects, warnings and faces of another model.
    void append(PatchModel other);
};

}  // namespace bandvox
