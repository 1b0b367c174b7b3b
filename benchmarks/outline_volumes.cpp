// How right drawings of volumes are, from all around: curves that do not close, free ends without a
// reason, samples that lines of sight in small steps contradict, anchors and seconds.
// `outline_volumes AZIMUTHS FILE.vdb...`

#include "outline/scenes.h"
#include "outline/volume_views.h"

#include <openvdb/io/File.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

namespace {

using namespace bandvox;
using namespace bandvox::outline_test;

struct VolumeTotals {
    Findings ends, sight;
    int open = 0, cusps = 0;
    std::size_t curves = 0, mostAnchors = 0;
    std::vector<double> seconds;
};

void addFindings(Findings& sum, const Findings& more, const std::string& view) {
    sum.samples += more.samples;
    sum.wrong += more.wrong;
    for (const std::string& message : more.messages) {
        std::printf("  %s: %s\n", view.c_str(), message.c_str());
    }
}

void measureVolume(const OutlineVolume& volume, const OutlineOptions& options,
                   const std::string& view, VolumeTotals& totals) {
    const VolumeLines lines = linesOf({volume}, options);
    const auto& surface = lines.drawing->surfaces()[0];
    const InsideMaker inside = [&]() -> InsideFunction {
        return [probe = std::shared_ptr(surface.object->probe()), &surface](const auto& world) {
            const auto index = surface.object->grid().worldToIndex(world);
            return probe->value(index) - surface.object->threshold();
        };
    };
    addFindings(totals.ends, checkEnds(lines.drawn), view);
    addFindings(totals.sight, checkVisibility(lines, inside, 1e-6), view);
    for (const Curve& curve : lines.drawing->curves()) {
        if (curve.closed) continue;
        const CurvePoint &a = curve.points.front(), &b = curve.points.back();
        std::printf("  %s: open, %zu points, at (%g, %g), voxel %g %g %g, to (%g, %g)\n",
                    view.c_str(), curve.points.size(), a.x, a.y, a.u, a.v, a.s, b.x, b.y);
    }
    totals.open += openCurves(lines);
    totals.cusps += cuspsOf(lines);
    totals.curves += lines.drawing->curves().size();
    const auto start = std::chrono::steady_clock::now();
    const Outline outline = volumesToOutline({volume}, {}, options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    totals.seconds.push_back(seconds.count());
    std::size_t anchors = 0;
    for (const OutlinePath& path : outline.paths) {
        if (path.hidden == 0) anchors += path.anchors();
    }
    totals.mostAnchors = std::max(totals.mostAnchors, anchors);
}

OutlineVolume readVolume(const std::string& name) {
    openvdb::io::File file(name);
    file.open();
    return {openvdb::gridPtrCast<openvdb::FloatGrid>(file.getGrids()->front()), {}, name};
}

}  // namespace

int main(int count, char** arguments) {
    openvdb::initialize();
    const int azimuths = count > 1 ? std::atoi(arguments[1]) : 26;
    for (int i = 2; i < count; ++i) {
        const OutlineVolume volume = readVolume(arguments[i]);
        VolumeTotals totals;
        for (const double elevation : {-0.2, 0.35, 1.0}) {
            for (int k = 0; k < azimuths; ++k) {
                for (const bool isPerspective : {false, true}) {
                    const double azimuth = 2 * std::numbers::pi * (k + 0.2) / azimuths;
                    const std::string view = std::to_string(k) + "/" + std::to_string(elevation) +
                                             (isPerspective ? " perspective" : " parallel");
                    measureVolume(volume, viewFrom(azimuth, elevation, isPerspective), view,
                                  totals);
                }
            }
        }
        std::sort(totals.seconds.begin(), totals.seconds.end());
        std::printf(
            "%s: %zu views, %zu curves, %d open, %d cusps, %d of %d ends loose, %d of %d samples "
            "wrong, %zu visible anchors at most, median %.3f s\n",
            volume.name.c_str(), totals.seconds.size(), totals.curves, totals.open, totals.cusps,
            totals.ends.wrong, totals.ends.samples, totals.sight.wrong, totals.sight.samples,
            totals.mostAnchors, totals.seconds[totals.seconds.size() / 2]);
    }
    return 0;
}
