// How right drawings of scenes are that hide, pass through and graze themselves, from all around:
// free ends without a reason, samples that lines of sight contradict, distances from the true
// curves, anchors and seconds. `outline_views [SCENE [AZIMUTHS [NUMBER]]]`; NUMBER: the only
// azimuth to look from

#include "outline/drawn_distance.h"
#include "outline/drawn_view.h"
#include "outline/scenes.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

namespace {

using namespace bandvox;
using namespace bandvox::outline_test;

struct Totals {
    Findings ends, sight;
    double apart = 0;
    std::size_t mostAnchors = 0;
    std::vector<double> seconds;
};

void add(Findings& sum, const Findings& more, const std::string& view) {
    sum.samples += more.samples;
    sum.wrong += more.wrong;
    sum.miscounted += more.miscounted;
    for (const std::string& message : more.messages) {
        std::printf("  %s: %s\n", view.c_str(), message.c_str());
    }
}

void measure(const Scene& scene, const OutlineOptions& options, const std::string& view,
             Totals& totals) {
    const DrawnView drawn = draw(scene.patches, options);
    add(totals.ends, checkEnds(drawn), view);
    add(totals.sight, checkVisibility(drawn), view);
    const PatchModel model{scene.patches, {"a", "b"}, {}};
    const auto start = std::chrono::steady_clock::now();
    const Outline outline = patchesToOutline(model, options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    totals.seconds.push_back(seconds.count());
    const double apart = largestDistance(outline, model, options);
    totals.apart = std::max(totals.apart, apart);
    if (apart > options.tolerance) std::printf("  %s: %.4f mm off\n", view.c_str(), apart);
    std::size_t anchors = 0;
    for (const OutlinePath& path : outline.paths) {
        if (path.hidden == 0) anchors += path.anchors();
    }
    totals.mostAnchors = std::max(totals.mostAnchors, anchors);
}

}  // namespace

int main(int count, char** arguments) {
    const std::string wanted = count > 1 ? arguments[1] : "";
    const int azimuths = count > 2 ? std::atoi(arguments[2]) : 26;
    const int only = count > 3 ? std::atoi(arguments[3]) : -1;
    for (const Scene& scene : scenes()) {
        if (!wanted.empty() && scene.name != wanted) continue;
        Totals totals;
        for (const double elevation : {-0.2, 0.35, 1.0}) {
            for (int k = 0; k < azimuths; ++k) {
                if (only >= 0 && k != only) continue;
                for (const bool isPerspective : {false, true}) {
                    const double azimuth = 2 * std::numbers::pi * (k + 0.2) / azimuths;
                    const std::string view = std::to_string(k) + "/" + std::to_string(elevation) +
                                             (isPerspective ? " perspective" : " parallel");
                    measure(scene, viewFrom(azimuth, elevation, isPerspective), view, totals);
                }
            }
        }
        std::sort(totals.seconds.begin(), totals.seconds.end());
        std::printf(
            "%s: %zu views, %d of %d ends loose, %d of %d samples wrong, %d "
            "counted wrong, %.4f mm off, %zu visible anchors at most, median %.3f s\n",
            scene.name.c_str(), totals.seconds.size(), totals.ends.wrong, totals.ends.samples,
            totals.sight.wrong, totals.sight.samples, totals.sight.miscounted, totals.apart,
            totals.mostAnchors, totals.seconds[totals.seconds.size() / 2]);
        std::fflush(stdout);
    }
}
