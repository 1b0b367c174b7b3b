#include "mesh_report.h"

#include "report_words.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/unite_shells.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace bandvox::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kHolesListed = 8;  // in words

Json boundsOf(const Mesh& mesh) {
    openvdb::BBoxd box;
    for (const openvdb::Vec3d& p : mesh.points) box.expand(p);
    return {{"min", toJson(box.min())}, {"max", toJson(box.max())}};
}

Json toJson(const std::vector<CappedHole>& holes) {
    Json list = Json::array();
    for (const CappedHole& hole : holes) {
        list.push_back({{"edges", hole.edges},
                        {"perimeter", hole.perimeter},
                        {"center", app::toJson(hole.center)}});
    }
    return list;
}

void addClosing(const CloseMeshReport& closing, Json& report) {
    report["pieces"] = closing.components;
    report["points_welded"] = closing.pointsWelded;
    report["triangles_without_area"] = closing.degenerateTriangles;
    report["duplicate_triangles"] = closing.duplicateTriangles;
    report["crack_points"] = closing.crackPoints;
    report["edges_split"] = closing.edgesSplit;
    report["triangles_flipped"] = closing.trianglesFlipped;
    report["pieces_turned"] = closing.componentsTurned;
    report["one_sided_pieces"] = closing.oneSided;
    report["non_manifold_edges"] = closing.nonManifoldEdges;
    report["soup_pieces"] = closing.soupPieces;
    report["soup_triangles"] = closing.soupTriangles;
    report["holes"] = toJson(closing.holes);
    for (const std::string& warning : closing.warnings) report["warnings"].push_back(warning);
}

// Makes a solid of it, as far as that goes.
void addSolid(Mesh mesh, Json& report, Progress& progress) {
    ClosedMesh closed =
        closeMesh(std::move(mesh), {.requireSolid = false, .capping = Capping::Sensible}, progress);
    addClosing(closed.report, report);
    if (!closed.report.problem.empty()) {
        report["problem"] = closed.report.problem;
        return;
    }
    // What a soup encloses only its winding numbers tell.
    if (!closed.soup.triangles.empty()) return;
    UnitedMesh united = uniteShells(std::move(closed.mesh), progress);
    report["triangle_meetings"] = united.report.meetings;
    report["triangles_inside"] = united.report.trianglesDropped;
    for (const std::string& warning : united.report.warnings) {
        report["warnings"].push_back(warning);
    }
    const MeshSource source("", std::move(united.mesh));
    report["area"] = source.area();
    report["volume"] = source.volume();
    report["closed"] = closed.report.warnings.empty() && united.report.warnings.empty();
}

std::string holesInWords(const Json& holes) {
    std::string out;
    for (std::size_t i = 0; i < std::min(holes.size(), kHolesListed); ++i) {
        const Json& hole = holes[i];
        out += "    " + inWords(hole["edges"]) + " edges, perimeter " + inWords(hole["perimeter"]) +
               ", around " + inWords(hole["center"]) + '\n';
    }
    if (holes.size() > kHolesListed) {
        out += "    and " + std::to_string(holes.size() - kHolesListed) + " smaller ones\n";
    }
    return out;
}

}  // namespace

Json meshReport(MeshFile file, Progress& progress) {
    Json report;
    report["points"] = file.mesh.points.size();
    report["triangles"] = file.mesh.triangles.size();
    report["objects"] = file.objects;
    report["bounds"] = boundsOf(file.mesh);
    report["warnings"] = file.warnings;
    report["triangle_meetings"] = nullptr;
    report["triangles_inside"] = nullptr;
    report["area"] = nullptr;
    report["volume"] = nullptr;
    report["closed"] = false;
    report["problem"] = nullptr;
    try {
        addSolid(std::move(file.mesh), report, progress);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input && error.kind() != ErrorKind::Result) throw;
        report["problem"] = error.what();
    }
    return report;
}

Json meshReport(const std::string& input, Progress& progress) {
    MeshFile file = readMesh(input, progress);
    Json report;
    report["file"] = input;
    report["file_bytes"] = std::filesystem::file_size(input);
    report.update(meshReport(std::move(file), progress));
    return report;
}

std::string meshReportInWords(const Json& report) {
    std::string out = inWords(report["file"]) + ": " +
                      formatBytes(report["file_bytes"].get<std::int64_t>()) + ", mesh\n";
    for (const char* key : {"points", "triangles", "objects"}) {
        appendLine(out, key, inWords(report[key]));
    }
    appendLine(out, "world box", boundsInWords(report["bounds"]));
    // Of what is found wrong only what is there.
    for (const auto& [key, value] : report.items()) {
        const bool isCount = value.is_number_unsigned() && value != 0;
        if (!isCount || key == "file_bytes" || key == "points" || key == "triangles" ||
            key == "objects") {
            continue;
        }
        std::string name = key;
        std::replace(name.begin(), name.end(), '_', ' ');
        appendLine(out, name, inWords(value));
    }
    if (report.contains("holes") && !report["holes"].empty()) {
        appendLine(out, "holes", std::to_string(report["holes"].size()));
        out += holesInWords(report["holes"]);
    }
    if (!report["volume"].is_null()) {
        appendLine(out, "area", inWords(report["area"]));
        appendLine(out, "volume", inWords(report["volume"]));
    }
    for (const Json& warning : report["warnings"]) appendLine(out, "warning", inWords(warning));
    if (!report["problem"].is_null()) appendLine(out, "no solid", inWords(report["problem"]));
    if (report["closed"].get<bool>()) appendLine(out, "closed", "yes");
    return out;
}

}  // namespace bandvox::app
