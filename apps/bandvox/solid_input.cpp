#include "solid_input.h"

#include "file_endings.h"
#include "words.h"

#include <bandvox/core/memory.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>
#include <bandvox/source/unite_shells.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace bandvox::app {
namespace {

constexpr std::size_t kHolesListed = 3;  // without --verbose

void sayHoles(CommandRun& run, const std::vector<CappedHole>& holes) {
    if (holes.empty()) return;
    const std::size_t listed = run.verbose() ? holes.size() : std::min(holes.size(), kHolesListed);
    run.say("capped   " + formatCount(static_cast<std::int64_t>(holes.size()), "hole", "holes") +
            ":");
    for (std::size_t i = 0; i < listed; ++i) {
        run.say("         " + std::to_string(holes[i].edges) + " edges, perimeter " +
                formatNumber(holes[i].perimeter) + ", around " + formatVector(holes[i].center));
    }
    if (listed < holes.size()) {
        run.say("         and " + std::to_string(holes.size() - listed) +
                " smaller ones (--verbose lists them)");
    }
}

void sayRepairs(CommandRun& run, const CloseMeshReport& report) {
    std::vector<std::string> parts;
    const auto add = [&](std::size_t count, const char* one, const char* many) {
        if (count > 0) {
            parts.push_back(formatCount(static_cast<std::int64_t>(count), one, many));
        }
    };
    add(report.components, "piece", "pieces");
    add(report.pointsWelded, "point welded", "points welded");
    add(report.degenerateTriangles, "triangle without area", "triangles without area");
    add(report.trianglesFlipped, "triangle flipped", "triangles flipped");
    add(report.componentsTurned, "piece turned outward", "pieces turned outward");
    add(report.soupTriangles, "triangle set aside", "triangles set aside");
    add(report.nonManifoldEdges, "edge of more than two triangles",
        "edges of more than two triangles");
    run.say("solid    " + joined(parts, ", "));
    sayHoles(run, report.holes);
}

void sayUnion(CommandRun& run, const UnionReport& report) {
    run.count("triangle_meetings", report.meetings);
    run.count("triangles_dropped", report.trianglesDropped);
    if (report.meetings == 0 && report.trianglesDropped == 0) return;
    const auto count = [](std::size_t n, const char* one, const char* many) {
        return formatCount(static_cast<std::int64_t>(n), one, many);
    };
    run.say("union    " + count(report.meetings, "pair", "pairs") + " of triangles meet, " +
            count(report.trianglesCut, "triangle", "triangles") + " cut up, " +
            count(report.trianglesDropped, "triangle", "triangles") + " dropped");
}

std::string meshOrShape() {
    return "mesh (" + joined(meshExtensions(), " ") +
           ") or a built-in shape (shape:" + joined(shapeNames(), " shape:") + ")";
}

}  // namespace

PositionalEntry solidInputEntry() {
    return {"INPUT",
            "A " + meshOrShape() + ".",
            false,
            {.words = shapeWords(), .endings = meshExtensions()}};
}

PatchSolid loadPatchSolid(CommandRun& run, const std::string& input,
                          const PatchSolidOptions& options) {
    PatchModel model = readPatches(input, run.progress());
    const auto count = [](std::size_t n, const char* one, const char* many) {
        return formatCount(static_cast<std::int64_t>(n), one, many);
    };
    run.say("read     " + input + ": " + count(model.patches.size(), "patch", "patches") + ", " +
            count(model.objects.size(), "object", "objects"));
    run.count("patches", model.patches.size());
    run.count("objects", model.objects.size());
    run.warn(model.warnings, ErrorKind::Input);
    PatchSolid solid = makePatchSolid(std::filesystem::path(input).filename().string(),
                                      std::move(model), options, run.progress());
    const PatchSolidReport& report = solid.report;
    std::vector<std::string> parts{count(report.pieces, "piece", "pieces")};
    if (report.patchesFlipped > 0) {
        parts.push_back(count(report.patchesFlipped, "patch flipped", "patches flipped"));
    }
    if (report.piecesTurned > 0) {
        parts.push_back(
            count(report.piecesTurned, "piece turned outward", "pieces turned outward"));
    }
    run.say("solid    " + joined(parts, ", "));
    sayHoles(run, report.holes);
    if (report.piecesMeeting > 0) {
        run.say("union    " + count(report.piecesMeeting, "piece", "pieces") + " near others");
    }
    run.count("holes_capped", report.holes.size());
    run.warn(report.warnings, ErrorKind::Input);
    return solid;
}

void requireMeshOrShape(const std::string& verb, const std::string& input) {
    if (isPatchFile(input)) {
        throw Error(ErrorKind::Input,
                    "cannot " + verb + " '" + input +
                        "': it holds free-form surfaces; make a mesh of them first: bandvox "
                        "convert " +
                        shellWord(input) + " -o " +
                        shellWord(std::filesystem::path(input).stem().string() + "-mesh.ply") +
                        " --resolution 256");
    }
    if (isShape(input) || isMeshFile(input)) return;
    const std::string extension = extensionOf(input);
    const std::string found = extension.empty() ? "it has no extension"
                              : extension == ".vdb"
                                  ? "it is a VDB already"
                                  : "'" + extension + "' is no kind of file that can be read";
    throw Error(ErrorKind::Input,
                "cannot " + verb + " '" + input + "': " + found + "; expected a " + meshOrShape());
}

SolidMesh loadSolidMesh(CommandRun& run, const std::string& input,
                        const SolidMeshOptions& options) {
    return makeSolidMesh(run, input, readMesh(input, run.progress()), options);
}

SolidMesh makeSolidMesh(CommandRun& run, const std::string& input, MeshFile file,
                        const SolidMeshOptions& options) {
    const std::filesystem::path path = input;
    run.say("read     " + path.string() + ": " +
            formatCount(static_cast<std::int64_t>(file.mesh.points.size()), "point", "points") +
            ", " +
            formatCount(static_cast<std::int64_t>(file.mesh.triangles.size()), "triangle",
                        "triangles") +
            ", " + formatCount(static_cast<std::int64_t>(file.objects), "object", "objects"));
    run.count("points", file.mesh.points.size());
    run.count("triangles", file.mesh.triangles.size());
    run.count("objects", file.objects);
    run.warn(file.warnings, ErrorKind::Input);

    ClosedMesh closed =
        closeMesh(std::move(file.mesh), {.capping = options.capping}, run.progress());
    sayRepairs(run, closed.report);
    run.count("holes_capped", closed.report.holes.size());
    run.count("soup_triangles", closed.report.soupTriangles);
    run.warn(closed.report.warnings, ErrorKind::Input);
    if (options.overlap == Overlap::Union && !closed.mesh.triangles.empty()) {
        UnitedMesh united = uniteShells(std::move(closed.mesh), run.progress());
        sayUnion(run, united.report);
        run.warn(united.report.warnings, ErrorKind::Input);
        closed.mesh = std::move(united.mesh);
    }
    // The mesh takes a part of what reading and mending it did.
    returnFreeMemory();
    return {path.filename().string(), std::move(closed.mesh), std::move(closed.soup),
            static_cast<int>(closed.report.holes.size())};
}

}  // namespace bandvox::app
