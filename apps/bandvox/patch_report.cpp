#include "patch_report.h"

#include "report_words.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/source/patch_solid.h>
#include <bandvox/source/read_patches.h>

#include <filesystem>
#include <utility>

namespace bandvox::app {
namespace {

using Json = nlohmann::ordered_json;

Json boundsJson(const openvdb::BBoxd& box) {
    return {{"min", toJson(box.min())}, {"max", toJson(box.max())}};
}

openvdb::BBoxd controlBox(const PatchModel& model) {
    openvdb::BBoxd box;
    for (const BezierPatch& patch : model.patches) {
        for (const auto& p : patch.control) box.expand(openvdb::Vec3d(p.data()) / p[3]);
    }
    return box;
}

void addPatchSolid(const std::string& name, PatchModel model, Json& report, Progress& progress) {
    const PatchSolid solid = makePatchSolid(name, std::move(model), {}, progress);
    const PatchSolidReport& found = solid.report;
    report["bounds"] = boundsJson(solid.source->bounds());
    report["pieces"] = found.pieces;
    report["patches_flipped"] = found.patchesFlipped;
    report["pieces_turned"] = found.piecesTurned;
    report["sides_shared_by_more"] = found.sidesSharedByMore;
    report["pieces_meeting"] = found.piecesMeeting;
    for (const CappedHole& hole : found.holes) {
        report["holes"].push_back({{"edges", hole.edges},
                                   {"perimeter", hole.perimeter},
                                   {"center", toJson(hole.center)}});
    }
    report["area"] = solid.source->area();
    report["volume"] = solid.source->volume();
    report["closed"] = found.holes.empty() && found.sidesSharedByMore == 0;
    for (const std::string& warning : found.warnings) report["warnings"].push_back(warning);
}

}  // namespace

Json patchReport(PatchModel model, Progress& progress, const std::string& name) {
    Json report;
    report["patches"] = model.patches.size();
    report["faces"] = model.topology.faces.size();
    report["objects"] = model.objects;
    report["bounds"] = nullptr;
    report["holes"] = Json::array();
    report["area"] = nullptr;
    report["volume"] = nullptr;
    report["closed"] = false;
    report["warnings"] = model.warnings;
    report["problem"] = nullptr;
    if (!model.patches.empty()) report["bounds"] = boundsJson(controlBox(model));
    try {
        addPatchSolid(name, std::move(model), report, progress);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input && error.kind() != ErrorKind::Result) throw;
        report["problem"] = error.what();
    }
    return report;
}

Json patchReport(const std::string& input, Progress& progress) {
    PatchModel model = readPatches(input, progress);
    Json report;
    report["file"] = input;
    report["file_bytes"] = nullptr;
    if (std::filesystem::is_regular_file(input)) {
        report["file_bytes"] = std::filesystem::file_size(input);
    }
    report.update(patchReport(std::move(model), progress, input));
    return report;
}

std::string patchReportInWords(const Json& report) {
    const Json& bytes = report["file_bytes"];
    std::string out = inWords(report["file"]) + ": " +
                      (bytes.is_null() ? "" : formatBytes(bytes.get<std::int64_t>()) + ", ") +
                      "free-form surfaces\n";
    appendLine(out, "patches", inWords(report["patches"]));
    if (report["faces"] != 0) appendLine(out, "faces", inWords(report["faces"]));
    appendLine(out, "objects", std::to_string(report["objects"].size()));
    appendLine(out, "world box", boundsInWords(report["bounds"]));
    if (!report["volume"].is_null()) {
        appendLine(out, "pieces", inWords(report["pieces"]));
        appendLine(out, "area", inWords(report["area"]));
        appendLine(out, "volume", inWords(report["volume"]));
    }
    for (const Json& warning : report["warnings"]) appendLine(out, "warning", inWords(warning));
    if (!report["problem"].is_null()) appendLine(out, "no solid", inWords(report["problem"]));
    if (report["closed"].get<bool>()) appendLine(out, "closed", "yes");
    return out;
}

}  // namespace bandvox::app
