#include "face_reader.h"

#include "fit_curve.h"
#include "nurbs_surface.h"

#include <bandvox/core/error.h>

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

// Of the larger coordinates: what polynomials leave of curves.
constexpr double kFitTolerance = 3e-12;

Handle(Geom2d_Curve) basisOf(Handle(Geom2d_Curve) curve) {
    while (true) {
        const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve);
        if (trimmed.IsNull()) return curve;
        curve = trimmed->BasisCurve();
    }
}

// An edge's curve in the surface's own parameters, as polynomials in the edge's parameter. Returns
// how far they are from it, as a part of the larger coordinates.
double fitPieces(const Handle(Geom2d_Curve) & curve, double first, double last,
                 std::vector<CadPiece>& pieces) {
    const CurveFunction function = [&](double t) {
        const gp_Pnt2d p = curve->Value(t);
        return std::array<double, 2>{p.X(), p.Y()};
    };
    std::vector<double> stops{first, last};
    if (const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(basisOf(curve));
        !spline.IsNull()) {
        for (int k = 1; k <= spline->NbKnots(); ++k) {
            const double knot = spline->Knot(k);
            if (knot > first && knot < last) stops.push_back(knot);
        }
    }
    std::sort(stops.begin(), stops.end());
    double size = 1e-300;
    for (const double t : stops) {
        const auto p = function(t);
        size = std::max({size, std::abs(p[0]), std::abs(p[1])});
    }
    const double least = 1e-9 * (last - first);
    double from = first, off = 0;
    for (const double to : stops) {
        if (to - from < least || (to < last && last - to < least)) continue;
        off = std::max(off, fitCurve(function, from, to, kFitTolerance * size, pieces));
        from = to;
    }
    for (CadPiece& piece : pieces) {
        piece.from = (piece.from - first) / (last - first);
        piece.to = (piece.to - first) / (last - first);
    }
    pieces.front().from = 0;
    pieces.back().to = 1;
    return off / size;
}

void expand(ParameterBox& box, const ParameterCurve& curve) {
    box.expand(curve.front());
    box.expand(curve.back());
    for (std::size_t axis = 0; axis < 2; ++axis) {
        for (const double t : turnsOf(curve, axis)) box.expand(jetAt(curve, t).place);
    }
}

// Goes from the surface's parameters to those of its B-spline. Returns how far off the curves may
// be by that, as a part of the face's parameters.
double toSpline(const NurbsSurface& surface, std::vector<CadPiece>& pieces) {
    std::vector<CadPiece> result;
    double off = 0;
    for (CadPiece& piece : pieces) {
        if (surface.keepsParameters()) {
            for (auto& p : piece.curve) p = surface.placeOf(p);
            result.push_back(std::move(piece));
            continue;
        }
        std::vector<double> stops{0, 1};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            for (const double line : surface.breaks(axis)) {
                for (const double t : crossingsOf(piece.curve, axis, line)) stops.push_back(t);
            }
        }
        std::sort(stops.begin(), stops.end());
        const CurveFunction function = [&](double t) {
            return surface.placeOf(jetAt(piece.curve, t).place);
        };
        double from = 0;
        for (const double to : stops) {
            constexpr double kShortest = 1e-9;
            if (to - from < kShortest || (to < 1 && 1 - to < kShortest)) continue;
            const std::size_t before = result.size();
            off = std::max(off, fitCurve(function, from, to, kFitTolerance, result));
            for (std::size_t k = before; k < result.size(); ++k) {
                result[k].from = piece.from + result[k].from * (piece.to - piece.from);
                result[k].to = piece.from + result[k].to * (piece.to - piece.from);
            }
            from = to;
        }
    }
    pieces = std::move(result);
    return off;
}

std::vector<TopoDS_Edge> edgesOf(const TopoDS_Wire& wire, const TopoDS_Face& face) {
    std::vector<TopoDS_Edge> ordered, all;
    for (BRepTools_WireExplorer walk(wire, face); walk.More(); walk.Next()) {
        ordered.push_back(walk.Current());
    }
    // A wire that is not connected is not gone through as a whole.
    for (TopExp_Explorer walk(wire, TopAbs_EDGE); walk.More(); walk.Next()) {
        all.push_back(TopoDS::Edge(walk.Current()));
    }
    std::vector<TopoDS_Edge>& edges = ordered.size() == all.size() ? ordered : all;
    std::erase_if(edges, [](const TopoDS_Edge& edge) {
        return edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED;
    });
    return edges;
}

class FaceReader {
  public:
    FaceReader(const TopoDS_Shape& shape, const ShapeNames& names, const InterruptCheck& check)
        : mNames(names), mCheck(check) {
        TopExp::MapShapes(shape, TopAbs_EDGE, mEdges);
        mShape.edges = mEdges.Extent();
        for (TopExp_Explorer walk(shape, TopAbs_SOLID); walk.More(); walk.Next()) {
            addObject(walk.Current());
        }
        for (TopExp_Explorer walk(shape, TopAbs_SHELL, TopAbs_SOLID); walk.More(); walk.Next()) {
            addObject(walk.Current());
        }
        bool isFirst = true;
        for (TopExp_Explorer walk(shape, TopAbs_FACE, TopAbs_SHELL); walk.More(); walk.Next()) {
            if (isFirst) mShape.objects.emplace_back();
            isFirst = false;
            add(TopoDS::Face(walk.Current()));
            ++mShell;
        }
    }

    CadShape take() {
        if (mRoughCurves > 0) {
            std::ostringstream warning;
            warning << "curves of edges turn too often to be followed to the end: " << mRoughCurves
                    << "; they are up to " << mMostOff << " of their faces' sizes off";
            mShape.warnings.push_back(warning.str());
        }
        return std::move(mShape);
    }

  private:
    void addObject(const TopoDS_Shape& shape) {
        mShape.objects.push_back(mNames(shape));
        for (TopExp_Explorer walk(shape, TopAbs_FACE); walk.More(); walk.Next()) {
            add(TopoDS::Face(walk.Current()));
        }
        ++mShell;
    }

    void add(const TopoDS_Face& face) {
        mCheck();
        const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
        if (surface.IsNull()) {
            throw Error(ErrorKind::Input,
                        "has a face without a surface, of triangles alone; "
                        "expected the surface");
        }
        CadFace made;
        made.isReversed = face.Orientation() == TopAbs_REVERSED;
        made.shell = mShell;
        made.object = static_cast<int>(mShape.objects.size()) - 1;
        ParameterBox box;
        for (TopExp_Explorer walk(face, TopAbs_WIRE); walk.More(); walk.Next()) {
            made.wires.push_back(wireOf(TopoDS::Wire(walk.Current()), face, box));
        }
        std::erase_if(made.wires, [](const auto& wire) { return wire.empty(); });
        if (made.wires.empty()) {
            surface->Bounds(box.low[0], box.high[0], box.low[1], box.high[1]);
        }
        for (std::size_t c = 0; c < 2; ++c) {
            if (!(box.high[c] > box.low[c])) return;  // a face without area
            constexpr double kEndless = 1e50;
            if (std::abs(box.low[c]) > kEndless || std::abs(box.high[c]) > kEndless) {
                throw Error(ErrorKind::Input, "has a face without an end; expected its borders");
            }
        }
        const NurbsSurface nurbs(surface, box);
        made.net = nurbs.net();
        for (auto& wire : made.wires) {
            for (CadEdgeUse& use : wire) noteOff(toSpline(nurbs, use.pieces));
        }
        mShape.faces.push_back(std::move(made));
    }

    std::vector<CadEdgeUse> wireOf(const TopoDS_Wire& wire, const TopoDS_Face& face,
                                   ParameterBox& box) {
        std::vector<CadEdgeUse> uses;
        for (const TopoDS_Edge& edge : edgesOf(wire, face)) {
            double first = 0, last = 0;
            const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
            if (curve.IsNull()) {
                throw Error(ErrorKind::Input,
                            "has an edge that no curve on its face tells the "
                            "place of; expected one");
            }
            if (!(last > first)) continue;
            CadEdgeUse use;
            use.edge = BRep_Tool::Degenerated(edge) ? -1 : mEdges.FindIndex(edge) - 1;
            use.isReversed = edge.Orientation() == TopAbs_REVERSED;
            noteOff(fitPieces(curve, first, last, use.pieces));
            for (const CadPiece& piece : use.pieces) expand(box, piece.curve);
            uses.push_back(std::move(use));
        }
        return uses;
    }

    void noteOff(double off) {
        constexpr double kNoticeable = 1e-6;
        if (off > kNoticeable) ++mRoughCurves;
        mMostOff = std::max(mMostOff, off);
    }

    const ShapeNames& mNames;
    const InterruptCheck& mCheck;
    TopTools_IndexedMapOfShape mEdges;
    CadShape mShape;
    int mShell = 0;
    int mRoughCurves = 0;
    double mMostOff = 0;
};

}  // namespace

CadShape facesOf(const TopoDS_Shape& shape, const ShapeNames& names, const InterruptCheck& check) {
    return FaceReader(shape, names, check).take();
}

}  // namespace bandvox
