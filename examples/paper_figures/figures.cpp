#include "figures.h"

#include "contact_sheet.h"
#include "pictures.h"

#include <bandvox/render/shading.h>

#include <sstream>
#include <string>
#include <utility>

namespace paper_figures {

using bandvox::Shading;

namespace {

constexpr bandvox::ExponentialFilter kNeverRings{2, 0.16};

// A number without the zeros at its end.
std::string shortened(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
}

}  // namespace

void writeOlderMethods(const std::filesystem::path& folder, const Solid& solid) {
    struct Method {
        Shading shading;
        const char* name;
        const char* caption;
    };
    const Method methods[] = {{Shading::Depth, "figure_1_depth", "1: depth only"},
                              {Shading::Phong, "figure_2_phong", "2: Phong"},
                              {Shading::Cross, "figure_3_cross", "3: cross mask"},
                              {Shading::Sobel2d, "figure_4_sobel2d", "4: 2-D Sobel"},
                              {Shading::Sobel3d, "figure_5_sobel3d", "5: 3-D Sobel"}};
    ContactSheet sheet{"figures_1_to_5", 6, 3, {}};
    for (const Light& light : lights()) {
        const std::string under = std::string("_") + light.name;
        for (const Method& method : methods) {
            sheet.panels.push_back({method.name + under, method.caption,
                                    voxelPicture(*solid.field, kScreen, method.shading, light)});
        }
        sheet.panels.push_back({"true_" + solid.name + under, "true normals",
                                truePicture(*solid.surface, kScreen, light).image});
    }
    writeContactSheet(folder, sheet);
}

void writeBandLimited(const std::filesystem::path& folder, const std::vector<Solid>& solids) {
    ContactSheet sheet{"figure_8", 2 * static_cast<int>(solids.size()), 3, {}};
    for (const Solid& solid : solids) {
        for (const Light& light : lights()) {
            sheet.panels.push_back({"figure_8_" + solid.name + "_" + light.name, light.caption,
                                    spectralPicture(*solid.field, {64, 8, kScreen}, light)});
        }
    }
    writeContactSheet(folder, sheet);
}

void writeSampling(const std::filesystem::path& folder, const Solid& solid) {
    ContactSheet sheet{"figure_9", 6, 3, {}};
    for (const int samples : {16, 32, 64}) {
        for (const Light& light : lights()) {
            const std::string setting = std::to_string(samples);
            sheet.panels.push_back({"figure_9_R" + setting + "_" + light.name,
                                    "R = " + setting + ", N = 16",
                                    spectralPicture(*solid.field, {samples, 16, kScreen}, light)});
        }
    }
    writeContactSheet(folder, sheet);
}

void writeMelting(const std::filesystem::path& folder, const MeltingSize& size) {
    const Light& light = lights()[kUpperRight];
    constexpr int kBallVoxels = 16;  // N
    ContactSheet balls{"figure_10_balls", 5, 256 / size.screen, {}};
    for (const int share : {2, 4}) {
        for (const double gap : {0.0, 0.5, 1.0, 1.5, 2.0}) {
            const SpectralSetting setting{8 * kBallVoxels, kBallVoxels, size.screen,
                                          1.0 / share,     true,        kNeverRings};
            balls.panels.push_back(
                {"figure_10_balls_" + std::to_string(balls.panels.size() + 1),
                 "d = max/" + std::to_string(share) + ", gap " + shortened(gap) + " voxels",
                 spectralPicture(*twoBalls(gap * kDomainSide / kBallVoxels), setting, light)});
        }
    }
    writeContactSheet(folder, balls);

    // Cutoffs are for 128 voxels.
    ContactSheet branches{"figure_10_tree", 4, 256 / size.screen, {}};
    const FieldPtr solid = tree();
    for (const auto& [share, cutoff] : {std::pair(2, 0.16), {16, 0.16}, {16, 0.08}, {16, 0.05}}) {
        const int n = size.treeVoxels;
        const SpectralSetting setting{4 * n,       n,    size.screen,
                                      1.0 / share, true, {2, cutoff * 128 / n}};
        branches.panels.push_back(
            {"figure_10_tree_" + std::to_string(branches.panels.size() + 1),
             "d = max/" + std::to_string(share) + ", cutoff " + shortened(cutoff),
             spectralPicture(*solid, setting, light)});
    }
    writeContactSheet(folder, branches);
}

}  // namespace paper_figures
