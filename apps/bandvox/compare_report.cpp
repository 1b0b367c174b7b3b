#include "compare_report.h"

#include "report_words.h"
#include "words.h"

#include <nlohmann/json.hpp>

namespace bandvox::app {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& number) {
    return number ? Json(*number) : Json(nullptr);
}

Json toJson(const ComparedInput& input) {
    return {{"file", input.file},
            {"grid", input.grid.empty() ? Json(nullptr) : Json(input.grid)},
            {"iso", orNull(input.iso)},
            {"volume", orNull(input.volume)},
            {"integral", orNull(input.integral)}};
}

const char* nameOfLattices(ComparedLattices lattices) {
    switch (lattices) {
        case ComparedLattices::Same:
            return "same";
        case ComparedLattices::Shifted:
            return "shifted";
        default:
            return "resampled";
    }
}

Json toJson(const GridDifference& values) {
    return {{"lattices", nameOfLattices(values.lattices)},
            {"voxels", values.voxels},
            {"maximum", values.maximum},
            {"at", app::toJson(values.at)},
            {"a", values.valueA},
            {"b", values.valueB},
            {"rms", values.rms},
            {"mean", values.mean},
            {"mean_absolute", values.meanAbsolute}};
}

Json toJson(const OneSidedDistance& distance) {
    return {{"maximum", distance.maximum},    {"at_most", distance.atMost},
            {"at", app::toJson(distance.at)}, {"nearest", app::toJson(distance.nearest)},
            {"mean", distance.mean},          {"rms", distance.rms},
            {"area", distance.area}};
}

Json toJson(const SurfaceDifference& surfaces) {
    return {{"hausdorff", surfaces.hausdorff},
            {"hausdorff_at_most", surfaces.hausdorffAtMost},
            {"mean_distance", surfaces.meanDistance},
            {"from_a", toJson(surfaces.fromA)},
            {"from_b", toJson(surfaces.fromB)},
            {"angle",
             {{"mean", surfaces.angles.mean},
              {"percent_95", surfaces.angles.percent95},
              {"maximum", surfaces.angles.maximum}}}};
}

std::string inShort(double number) {
    return formatNumber(number, 4);
}

// "0.0123 (0.98 voxels)".
std::string lengthInWords(double length, const std::optional<double>& voxel) {
    std::string text = inShort(length);
    if (voxel) text += " (" + inShort(length / *voxel) + " voxels)";
    return text;
}

void appendInput(std::string& out, const char* letter, const ComparedInput& input) {
    std::string text = printable(input.file);
    if (!input.grid.empty()) text += ", grid '" + printable(input.grid) + "'";
    if (input.iso) text += ", surface at " + formatNumber(*input.iso);
    appendLine(out, letter, text);
}

void appendPair(std::string& out, const char* name, const std::optional<double>& a,
                const std::optional<double>& b) {
    if (!a || !b) return;
    std::string text = formatNumber(*a, 8);
    text += " and " + formatNumber(*b, 8);
    if (const auto relative = relativeDifference(a, b)) {
        text += ", " + inShort(100 * *relative) + " %";
    }
    appendLine(out, name, text);
}

void appendValues(std::string& out, const GridDifference& values) {
    out += "\nvalues, B less A\n";
    const char* const how[] = {"voxel by voxel", "voxel by voxel, whole voxels apart",
                               "on A's lattice, B read between its voxels"};
    appendLine(out, "compared",
               formatCount(values.voxels, "voxel", "voxels") + ", " +
                   how[static_cast<std::size_t>(values.lattices)]);
    std::string text = inShort(values.maximum);
    text += " at " + formatVector(values.at);
    text += ", where A is " + inShort(values.valueA);
    text += " and B " + inShort(values.valueB);
    appendLine(out, "maximum", text);
    appendLine(out, "rms", inShort(values.rms));
    appendLine(out, "mean", inShort(values.mean) + ", absolute " + inShort(values.meanAbsolute));
}

void appendSide(std::string& out, const char* name, const OneSidedDistance& distance,
                const std::optional<double>& voxel) {
    std::string text = "at most " + lengthInWords(distance.maximum, voxel);
    text += " at " + formatVector(distance.at);
    text += ", mean " + lengthInWords(distance.mean, voxel);
    appendLine(out, name, text);
}

void appendSurfaces(std::string& out, const SurfaceDifference& surfaces,
                    const std::optional<double>& voxel) {
    out += "\nsurfaces\n";
    appendLine(out, "Hausdorff",
               lengthInWords(surfaces.hausdorff, voxel) + ", no more than " +
                   lengthInWords(surfaces.hausdorffAtMost, voxel));
    appendSide(out, "from A to B", surfaces.fromA, voxel);
    appendSide(out, "from B to A", surfaces.fromB, voxel);
    appendLine(out, "mean distance", lengthInWords(surfaces.meanDistance, voxel));
    const NormalAngles& angles = surfaces.angles;
    std::string text = "mean " + inShort(angles.mean);
    text += ", 95 % below " + inShort(angles.percent95);
    text += ", largest " + inShort(angles.maximum);
    appendLine(out, "normals, degrees", text);
}

}  // namespace

std::optional<double> relativeDifference(const std::optional<double>& a,
                                         const std::optional<double>& b) {
    if (!a || !b || *a == 0) return std::nullopt;
    return (*b - *a) / *a;
}

nlohmann::ordered_json comparisonReport(const ComparisonResult& result) {
    Json report;
    report["a"] = toJson(result.a);
    report["b"] = toJson(result.b);
    report["voxel"] = orNull(result.voxel);
    report["values"] = result.values ? toJson(*result.values) : Json(nullptr);
    report["surfaces"] = result.surfaces ? toJson(*result.surfaces) : Json(nullptr);
    report["volume_difference"] = orNull(relativeDifference(result.a.volume, result.b.volume));
    report["integral_difference"] =
        orNull(relativeDifference(result.a.integral, result.b.integral));
    return report;
}

std::string comparisonInWords(const ComparisonResult& result) {
    std::string out;
    appendInput(out, "A", result.a);
    appendInput(out, "B", result.b);
    if (result.values) appendValues(out, *result.values);
    if (result.surfaces) appendSurfaces(out, *result.surfaces, result.voxel);
    if (result.a.volume || result.a.integral) out += "\nsizes\n";
    appendPair(out, "volume", result.a.volume, result.b.volume);
    appendPair(out, "integral", result.a.integral, result.b.integral);
    return out;
}

}  // namespace bandvox::app
