#pragma once

#include "source/parameter_curve.h"

#include <bandvox/source/face_topology.h>

#include <cstdint>
#include <vector>

namespace bandvox {

/// Answers which places of patches belong to their faces. Many threads may ask at once.
class FaceRegions {
  public:
    FaceRegions() = default;
    /// The topology is kept by reference.
    explicit FaceRegions(const FaceTopology& topology);

    /// Whether a patch belongs to a face of which loops leave a part only.
    bool isTrimmed(int patch) const { return regionOf(patch) != nullptr; }

    /// Whether the place (u, v) of a patch belongs to its face: a line along u from there crosses
    /// the loops an odd number of times.
    bool keeps(int patch, double u, double v) const;

    /// Whether loops may pass through a rectangle of a patch's parameters: for those that do not
    /// run along it the answer is exact but for curvature within.
    bool mayCut(int patch, const ParameterBox& box) const;

    /// A part of a loop along which v does not turn back.
    struct Part {
        ParameterCurve curve;
        ParameterBox box;
        bool isRising = true;

        /// The curve's parameter where it has this v, which is one of its own.
        double shareAt(double v) const;
        /// Whether it may pass through a rectangle.
        bool meets(const ParameterBox& other) const;
    };

    /// Calls visit(part) for the parts of loops that may pass through a rectangle of a patch's
    /// parameters, each once.
    template <class Visit>
    void visitParts(int patch, const ParameterBox& box, const Visit& visit) const {
        const Region* region = regionOf(patch);
        if (!region) return;
        const ParameterBox inside = inFace(patch, box);
        const std::size_t first = rowOf(inside.low[1]), last = rowOf(inside.high[1]);
        for (std::size_t r = first; r <= last; ++r) {
            for (const std::uint32_t k : region->rows[r]) {
                const Part& part = region->parts[k];
                const bool isKnown = r > first && rowOf(part.box.low[1]) < r;
                if (!isKnown && part.box.meets(inside)) visit(part);
            }
        }
    }

    const FaceTopology& topology() const { return *mTopology; }

    /// The pieces of all edges, one after the other.
    const EdgePiece& piece(int number) const { return *mPieces[static_cast<std::size_t>(number)]; }
    /// The edge that a piece is of.
    const FaceEdge& edgeOf(int number) const { return *mEdges[static_cast<std::size_t>(number)]; }

  private:
    struct Region {
        std::vector<Part> parts;
        std::vector<std::vector<std::uint32_t>> rows;  // parts by the v that they may have
    };

    const Region* regionOf(int patch) const;
    ParameterBox inFace(int patch, const ParameterBox& box) const;
    static std::size_t rowOf(double v);

    const FaceTopology* mTopology = nullptr;
    std::vector<const EdgePiece*> mPieces;
    std::vector<const FaceEdge*> mEdges;  // of pieces
    std::vector<Region> mRegions;         // one for each face, without parts if it is not trimmed
};

/// The place of a patch in its face; none without faces.
inline FacePlace placeOf(const FaceRegions* faces, int patch) {
    return faces ? faces->topology().placeOf(static_cast<std::size_t>(patch)) : FacePlace();
}

}  // namespace bandvox
