#include "source/cad_to_patches.h"

#include "source/near_knots.h"
#include "source/parameter_curve.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace bandvox {
namespace {

constexpr double kOnSide = 1e-9;  // of a face's parameters

// Exchanges u and v, which turns the normal.
void turn(CadFace& face) {
    BsplineNet& net = face.net;
    std::vector<std::array<double, 4>> control;
    control.reserve(net.control.size());
    for (int j = 0; j < net.count[1]; ++j) {
        for (int i = 0; i < net.count[0]; ++i) {
            const auto row = static_cast<std::size_t>(i) * static_cast<std::size_t>(net.count[1]);
            control.push_back(net.control[row + static_cast<std::size_t>(j)]);
        }
    }
    net.control = std::move(control);
    std::swap(net.degree[0], net.degree[1]);
    std::swap(net.count[0], net.count[1]);
    std::swap(net.knots[0], net.knots[1]);
    for (auto& wire : face.wires) {
        for (CadEdgeUse& use : wire) {
            for (CadPiece& piece : use.pieces) {
                for (auto& p : piece.curve) std::swap(p[0], p[1]);
            }
        }
    }
    face.isReversed = false;
}

// The knots of an axis, each once, as parts of their range.
std::vector<double> linesOf(const BsplineNet& net, std::size_t axis) {
    const auto& knots = net.knots[axis];
    const auto first = static_cast<std::size_t>(net.degree[axis]);
    const auto last = static_cast<std::size_t>(net.count[axis]);
    std::vector<double> lines;
    for (std::size_t k = first; k <= last; ++k) {
        const double line = (knots[k] - knots[first]) / (knots[last] - knots[first]);
        if (lines.empty() || line > lines.back()) lines.push_back(line);
    }
    return lines;
}

// Puts what lies on a side of the face's parameters exactly there.
void snap(ParameterCurve& curve) {
    for (std::size_t c = 0; c < 2; ++c) {
        for (const double side : {0.0, 1.0}) {
            const bool isOn = std::all_of(curve.begin(), curve.end(), [&](const auto& p) {
                return std::abs(p[c] - side) < kOnSide;
            });
            if (!isOn) continue;
            for (auto& p : curve) p[c] = side;
        }
        for (auto* end : {&curve.front(), &curve.back()}) {
            for (const double side : {0.0, 1.0}) {
                if (std::abs((*end)[c] - side) < kOnSide) (*end)[c] = side;
            }
        }
    }
}

// Whether loops run along the sides of the unit square only, all around.
bool isWhole(const std::vector<ParameterCurve>& loops) {
    double length = 0;
    for (const ParameterCurve& curve : loops) {
        bool isOnSide = false;
        for (std::size_t c = 0; c < 2; ++c) {
            for (const double side : {0.0, 1.0}) {
                isOnSide |= std::all_of(curve.begin(), curve.end(),
                                        [&](const auto& p) { return p[c] == side; });
            }
        }
        if (!isOnSide) return false;
        length +=
            std::hypot(curve.back()[0] - curve.front()[0], curve.back()[1] - curve.front()[1]);
    }
    return std::abs(length - 4) < 1e-6;
}

/// Makes patches of faces, one face after the other.
class FacesToPatches {
  public:
    explicit FacesToPatches(int edges) { topology().edges.resize(static_cast<std::size_t>(edges)); }

    void add(CadFace face) {
        if (face.isReversed) turn(face);
        joinNearKnots(face.net);
        mFirst = static_cast<int>(mModel.patches.size());
        mLines = {linesOf(face.net, 0), linesOf(face.net, 1)};
        addPatches(face);
        TrimmedFace trimmed{.shell = face.shell, .loops = {}};
        for (auto& wire : face.wires) {
            for (CadEdgeUse& use : wire) {
                for (CadPiece& piece : use.pieces) snap(piece.curve);
                addUse(use);
            }
            closeLoop(wire, trimmed.loops);
        }
        if (isWhole(trimmed.loops)) trimmed.loops.clear();
        topology().faces.push_back(std::move(trimmed));
    }

    PatchModel take() {
        // What no face has any more is left of degenerate ones.
        std::erase_if(topology().edges, [](const FaceEdge& edge) { return edge.uses.empty(); });
        return std::move(mModel);
    }

  private:
    FaceTopology& topology() { return mModel.topology; }
    int faceIndex() { return static_cast<int>(topology().faces.size()); }

    void addPatches(const CadFace& face) {
        std::vector<BezierPatch> patches = bezierPatches(face.net);
        const std::size_t columns = mLines[0].size() - 1, rows = mLines[1].size() - 1;
        for (std::size_t i = 0; i < columns; ++i) {
            for (std::size_t j = 0; j < rows; ++j) {
                BezierPatch& patch = patches[i * rows + j];
                patch.object = face.object;
                mModel.patches.push_back(std::move(patch));
                topology().places.push_back(
                    {.face = faceIndex(),
                     .range = {{{mLines[0][i], mLines[0][i + 1]},
                                {mLines[1][j], mLines[1][j + 1]}}},
                     .inner = {i > 0, i + 1 < columns, j > 0, j + 1 < rows}});
            }
        }
    }

    void addUse(const CadEdgeUse& use) {
        if (use.edge < 0) return;
        EdgeUse made{.face = faceIndex(), .isReversed = use.isReversed, .pieces = {}};
        for (const CadPiece& piece : use.pieces) addPieces(piece, made.pieces);
        topology().edges[static_cast<std::size_t>(use.edge)].uses.push_back(std::move(made));
    }

    // Cuts a piece where it passes from patch to patch.
    void addPieces(const CadPiece& piece, std::vector<EdgePiece>& pieces) {
        std::vector<double> cuts{0, 1};
        for (std::size_t c = 0; c < 2; ++c) {
            for (std::size_t k = 1; k + 1 < mLines[c].size(); ++k) {
                for (const double t : crossingsOf(piece.curve, c, mLines[c][k])) cuts.push_back(t);
            }
        }
        std::sort(cuts.begin(), cuts.end());
        constexpr double kShortest = 1e-9;
        std::vector<double> kept{0};
        for (const double t : cuts) {
            if (t - kept.back() > kShortest && 1 - t > kShortest) kept.push_back(t);
        }
        kept.push_back(1);
        for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
            EdgePiece part;
            part.curve = partOf(piece.curve, kept[i], kept[i + 1]);
            part.from = piece.from + kept[i] * (piece.to - piece.from);
            part.to = i + 2 == kept.size() ? piece.to
                                           : piece.from + kept[i + 1] * (piece.to - piece.from);
            toPatch(part);
            pieces.push_back(std::move(part));
        }
    }

    // Finds the patch that a piece lies on, and goes to its parameters.
    void toPatch(EdgePiece& piece) const {
        const auto middle = jetAt(piece.curve, 0.5).place;
        std::array<std::size_t, 2> cell{};
        for (std::size_t c = 0; c < 2; ++c) {
            const auto above =
                std::upper_bound(mLines[c].begin() + 1, mLines[c].end() - 1, middle[c]);
            cell[c] = static_cast<std::size_t>(above - mLines[c].begin()) - 1;
            const double low = mLines[c][cell[c]], high = mLines[c][cell[c] + 1];
            for (auto& p : piece.curve) p[c] = (p[c] - low) / (high - low);
            // Only control points between the ends may be outside.
            for (auto* end : {&piece.curve.front(), &piece.curve.back()}) {
                (*end)[c] = std::clamp((*end)[c], 0.0, 1.0);
            }
        }
        piece.patch = mFirst + static_cast<int>(cell[0] * (mLines[1].size() - 1) + cell[1]);
    }

    // Appends a wire in its own direction; ends that differ by rounding are made one, larger gaps
    // are closed by lines.
    void closeLoop(const std::vector<CadEdgeUse>& wire, std::vector<ParameterCurve>& loops) const {
        constexpr double kRounding = 1e-7;
        std::vector<ParameterCurve> curves;
        for (const CadEdgeUse& use : wire) {
            std::vector<ParameterCurve> ofUse;
            for (const CadPiece& piece : use.pieces) ofUse.push_back(piece.curve);
            if (use.isReversed) {
                std::reverse(ofUse.begin(), ofUse.end());
                for (ParameterCurve& curve : ofUse) std::reverse(curve.begin(), curve.end());
            }
            std::move(ofUse.begin(), ofUse.end(), std::back_inserter(curves));
        }
        const std::size_t count = curves.size();
        for (std::size_t k = 0; k < count; ++k) {
            const auto end = curves[k].back();
            auto& start = curves[(k + 1) % count].front();
            const double gap = std::max(std::abs(start[0] - end[0]), std::abs(start[1] - end[1]));
            if (gap == 0) continue;
            if (gap < kRounding) {
                curves[k].back() = start;
            } else {
                loops.push_back({end, start});
            }
        }
        std::move(curves.begin(), curves.end(), std::back_inserter(loops));
    }

    PatchModel mModel;
    int mFirst = 0;
    std::array<std::vector<double>, 2> mLines;
};

}  // namespace

PatchModel patchesOf(CadShape shape) {
    FacesToPatches work(shape.edges);
    for (CadFace& face : shape.faces) work.add(std::move(face));
    PatchModel model = work.take();
    model.objects = std::move(shape.objects);
    model.warnings = std::move(shape.warnings);
    return model;
}

}  // namespace bandvox
