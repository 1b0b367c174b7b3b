// How right the fills of drawings are, from all around: every pixel of a picture of what lines of
// sight see, object and tone, against the fills' own pixels; those within a pixel of a line or a
// border are left out. `outline_fills PIXELS AZIMUTHS [FILE.vdb...]`; PIXELS: along the page's
// longer side.

#include "outline/drawing/draw_curves.h"
#include "outline/drawn_view.h"
#include "outline/filled_page.h"
#include "outline/scenes.h"
#include "outline/volumes/volume_drawing.h"

#include <openvdb/io/File.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

namespace {

using namespace bandvox;
using namespace bandvox::outline_test;

struct FillTotals {
    std::int64_t pixels = 0, wrong = 0, wrongTones = 0, layered = 0;
    std::vector<double> seconds;
};

void measure(const std::function<Outline(const OutlineOptions&)>& draw, const CurveScene& scene,
             const OutlineOptions& options, double pixel, const std::string& view,
             FillTotals& totals) {
    const auto start = std::chrono::steady_clock::now();
    const Outline outline = draw(options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    totals.seconds.push_back(seconds.count());
    const FilledPage page(outline, pixel);
    std::atomic<std::int64_t> pixels = 0, wrong = 0, wrongTones = 0, layered = 0;
    parallelFor(page.height(), [&](std::int64_t row) {
        const auto reader = scene.reader();
        const int j = static_cast<int>(row);
        for (int i = 0; i < page.width(); ++i) {
            if (page.isNearEdge(i, j)) continue;
            const auto [x, y] = page.middle(i, j);
            const SeenSurface seen = reader->seenAt(x, y);
            const int number = page.fillAt(i, j);
            const OutlineFill none{.object = -1};
            const OutlineFill& fill =
                number < 0 ? none : outline.fills[static_cast<std::size_t>(number)];
            ++pixels;
            layered += page.layersAt(i, j) > 1 ? 1 : 0;
            const auto tone = std::count_if(options.tones.begin(), options.tones.end(),
                                            [&](double limit) { return seen.cosine > limit; });
            const bool isOther = fill.object != seen.object;
            const bool isOtherTone = !isOther && seen.object >= 0 && fill.tone != tone;
            if ((isOther || isOtherTone) && wrong + wrongTones < 3) {
                std::printf("  %s: (%.3f, %.3f) is filled as %d tone %d, and shows %d tone %d\n",
                            view.c_str(), x, y, fill.object, fill.tone, seen.object,
                            static_cast<int>(tone));
            }
            wrong += isOther ? 1 : 0;
            wrongTones += isOtherTone ? 1 : 0;
        }
    });
    totals.pixels += pixels;
    totals.wrong += wrong;
    totals.wrongTones += wrongTones;
    totals.layered += layered;
}

void measurePatches(const outline_test::Scene& scene, const OutlineOptions& options, double pixel,
                    const std::string& view, FillTotals& totals) {
    const double size = std::max(options.width, options.height);
    const auto seen = seenBy(pageView(scene.patches, options), scene.patches, size);
    const LitPatches lit{scene.patches, seen, lightDirection(contentOf(scene.patches), options)};
    const PatchModel model{scene.patches, {"a", "b"}, {}};
    measure([&](const OutlineOptions& wanted) { return patchesToOutline(model, wanted); },
            PatchScene(lit, size), options, pixel, view, totals);
}

void measureVolume(const OutlineVolume& volume, const OutlineOptions& options, double pixel,
                   const std::string& view, FillTotals& totals) {
    const PatchModel none;
    const VolumeDrawing drawing({volume}, none, options, silentProgress());
    measure([&](const OutlineOptions& wanted) { return volumesToOutline({volume}, none, wanted); },
            drawing.scene(), options, pixel, view, totals);
}

void measureViews(const std::string& name, int azimuths,
                  const std::function<void(OutlineOptions, const std::string&, FillTotals&)>& one) {
    FillTotals totals;
    for (const double elevation : {-0.2, 0.35, 1.0}) {
        for (int k = 0; k < azimuths; ++k) {
            for (const bool isPerspective : {false, true}) {
                const double azimuth = 2 * std::numbers::pi * (k + 0.2) / azimuths;
                OutlineOptions options = viewFrom(azimuth, elevation, isPerspective);
                options.fill = OutlineFillKind::Toon;
                one(options,
                    name + " " + std::to_string(k) + "/" + std::to_string(elevation) +
                        (isPerspective ? " perspective" : " parallel"),
                    totals);
            }
        }
    }
    std::sort(totals.seconds.begin(), totals.seconds.end());
    std::printf(
        "%s: %zu views, of %lld pixels %lld show another object, %lld another tone, %lld "
        "are filled twice, median %.3f s\n",
        name.c_str(), totals.seconds.size(), static_cast<long long>(totals.pixels),
        static_cast<long long>(totals.wrong), static_cast<long long>(totals.wrongTones),
        static_cast<long long>(totals.layered), totals.seconds[totals.seconds.size() / 2]);
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    openvdb::initialize();
    const int pixels = count > 1 ? std::atoi(arguments[1]) : 2048;
    const int azimuths = count > 2 ? std::atoi(arguments[2]) : 26;
    const OutlineOptions standard;
    const double pixel = std::max(standard.width, standard.height) / pixels;
    for (int i = 3; i < count; ++i) {
        openvdb::io::File file(arguments[i]);
        file.open();
        const OutlineVolume volume{
            openvdb::gridPtrCast<openvdb::FloatGrid>(file.getGrids()->front()), {}, arguments[i]};
        measureViews(
            volume.name, azimuths,
            [&](const OutlineOptions& options, const std::string& view, FillTotals& totals) {
                measureVolume(volume, options, pixel, view, totals);
            });
    }
    if (count > 3) return 0;
    for (const outline_test::Scene& scene : scenes()) {
        measureViews(
            scene.name, azimuths,
            [&](const OutlineOptions& options, const std::string& view, FillTotals& totals) {
                measurePatches(scene, options, pixel, view, totals);
            });
    }
    return 0;
}
