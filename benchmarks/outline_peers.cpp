// Newell's teapot as lines: patchesToOutline beside the two hidden-line algorithms of Open CASCADE,
// of its exact surfaces (HLRBRep_Algo) and of their triangles (HLRBRep_PolyAlgo), which it meshes
// in advance and without being timed. Parallel views from all around, by turns. `outline_peers
// [AZIMUTHS [FILE.json]]`

#include "build_places.h"

#include <bandvox/outline/patches_to_outline.h>
#include <bandvox/source/read_patches.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <Geom_BezierSurface.hxx>
#include <HLRAlgo_Projector.hxx>
#include <HLRBRep_Algo.hxx>
#include <HLRBRep_HLRToShape.hxx>
#include <HLRBRep_PolyAlgo.hxx>
#include <HLRBRep_PolyHLRToShape.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Shape.hxx>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gp_Ax2.hxx>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace bandvox;

constexpr double kTriangles = 0.005;  // deviation of the triangles, of the teapot's width

TopoDS_Shape shapeOf(const PatchModel& model) {
    BRepBuilderAPI_Sewing sewing(1e-6);
    for (const BezierPatch& patch : model.patches) {
        TColgp_Array2OfPnt points(1, patch.degreeU + 1, 1, patch.degreeV + 1);
        for (int i = 0; i <= patch.degreeU; ++i) {
            for (int j = 0; j <= patch.degreeV; ++j) {
                const auto& p = patch.at(i, j);
                points.SetValue(i + 1, j + 1, gp_Pnt(p[0] / p[3], p[1] / p[3], p[2] / p[3]));
            }
        }
        sewing.Add(BRepBuilderAPI_MakeFace(new Geom_BezierSurface(points), 1e-6).Face());
    }
    sewing.Perform();
    return sewing.SewedShape();
}

struct Method {
    std::string name;
    std::function<void(const gp_Dir& from)> draw;
    std::vector<double> seconds{};
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
    const int azimuths = count > 1 ? std::atoi(arguments[1]) : 8;
    if (azimuths < 1) {
        std::fprintf(stderr, "found '%s' azimuths; expected 1 or more\n", arguments[1]);
        return 2;
    }
    const PatchModel model = readPatches(std::filesystem::path(build_places::sources()) /
                                         "examples" / "data" / "teapot.bpt");
    const TopoDS_Shape shape = shapeOf(model);
    const BRepMesh_IncrementalMesh mesh(shape, kTriangles * 6.4);
    const auto projectorOf = [](const gp_Dir& from) {
        return HLRAlgo_Projector(gp_Ax2(gp_Pnt(0, 0, 0), from));
    };
    std::vector<Method> methods;
    methods.push_back({"patchesToOutline", [&](const gp_Dir& from) {
                           OutlineOptions options;
                           options.camera.projection = CameraOptions::Projection::Orthographic;
                           options.camera.from = {from.X(), from.Y(), from.Z()};
                           options.camera.up = openvdb::Vec3d(0, 0, 1);
                           patchesToOutline(model, options);
                       }});
    methods.push_back({"HLRBRep_Algo", [&](const gp_Dir& from) {
                           const Handle(HLRBRep_Algo) algorithm = new HLRBRep_Algo;
                           algorithm->Add(shape);
                           algorithm->Projector(projectorOf(from));
                           algorithm->Update();
                           algorithm->Hide();
                           HLRBRep_HLRToShape lines(algorithm);
                           lines.VCompound();
                           lines.OutLineVCompound();
                           lines.HCompound();
                           lines.OutLineHCompound();
                       }});
    methods.push_back({"HLRBRep_PolyAlgo", [&](const gp_Dir& from) {
                           const Handle(HLRBRep_PolyAlgo) algorithm = new HLRBRep_PolyAlgo;
                           algorithm->Load(shape);
                           algorithm->Projector(projectorOf(from));
                           algorithm->Update();
                           HLRBRep_PolyHLRToShape lines;
                           lines.Update(algorithm);
                           lines.VCompound();
                           lines.OutLineVCompound();
                           lines.HCompound();
                           lines.OutLineHCompound();
                       }});
    for (const double elevation : {0.15, 0.6, 1.1}) {
        for (int k = 0; k < azimuths; ++k) {
            const double azimuth = 2 * std::numbers::pi * (k + 0.3) / azimuths;
            const gp_Dir from(std::cos(azimuth) * std::cos(elevation),
                              std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
            for (Method& method : methods) {
                const auto start = std::chrono::steady_clock::now();
                method.draw(from);
                const std::chrono::duration<double> taken =
                    std::chrono::steady_clock::now() - start;
                method.seconds.push_back(taken.count());
            }
        }
    }
    std::string json = "{\"views\": " + std::to_string(methods[0].seconds.size());
    const double ours = median(methods[0].seconds);
    std::printf("| method | median s a view | of ours |\n| --- | --- | --- |\n");
    for (const Method& method : methods) {
        const double seconds = median(method.seconds);
        std::printf("| %s | %.4f | %.2f |\n", method.name.c_str(), seconds, seconds / ours);
        json += ", \"" + method.name + "\": " + std::to_string(seconds);
    }
    json += "}\n";
    if (count < 3) return 0;
    std::ofstream file(arguments[2]);
    file << json;
    if (file.flush()) return 0;
    std::fprintf(stderr, "cannot write '%s'\n", arguments[2]);
    return 1;
}
