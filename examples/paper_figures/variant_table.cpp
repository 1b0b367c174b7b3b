#include "figures.h"
#include "measures.h"
#include "pictures.h"
#include "table.h"

#include <bandvox/spectral/exponential_filter.h>

#include <string>
#include <vector>

namespace paper_figures {

namespace {

// What is done otherwise than in the figures.
struct Variant {
    std::string name;
    bandvox::ExponentialFilter filter = SpectralSetting().filter;
    double move = 0;  // of the solids along each axis, distances between samples
};

const std::vector<Variant>& variants() {
    static const std::vector<Variant> list{{"filter (2, 0.16)", {2, 0.16}},
                                           {"filter (4, 0.25)", {4, 0.25}},
                                           {"filter (6, 0.35)"},
                                           {"filter (8, 0.40)", {8, 0.4}},
                                           {"samples at centres of cells", {6, 0.35}, 0.5}};
    return list;
}

}  // namespace

void writeVariants(const std::filesystem::path& folder) {
    Table table({"variant", "R", "N", "sphere", "hyperboloid", "cube", "hyperboloid off edges",
                 "cube off edges"});
    for (const Variant& variant : variants()) {
        for (const auto& [samples, resolution] : {std::pair(64, 8), {128, 16}, {256, 32}}) {
            const double move = variant.move * kDomainSide / samples;
            const SpectralSetting setting{.samples = samples,
                                          .resolution = resolution,
                                          .size = kScreen,
                                          .filter = variant.filter};
            std::vector<std::string> all, offEdges;
            for (const Solid& solid : solids(openvdb::Vec3d(move))) {
                const bandvox::Image image =
                    spectralPicture(*solid.field, setting, lights()[kFront]);
                const auto mean = [&](double edgeDistance) {
                    return fixed(normalErrors(image, *solid.surface, edgeDistance).mean, 3);
                };
                all.push_back(mean(0));
                offEdges.push_back(mean(kEdgeDistance));
            }
            table.addRow({variant.name, std::to_string(samples), std::to_string(resolution), all[1],
                          all[0], all[2], offEdges[0], offEdges[2]});
        }
    }
    table.write(folder, "variants");
}

}  // namespace paper_figures
