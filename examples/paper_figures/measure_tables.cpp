#include "figures.h"
#include "measures.h"
#include "pictures.h"
#include "table.h"

#include <bandvox/render/shading.h>

#include <string>
#include <utility>
#include <vector>

namespace paper_figures {

using bandvox::Image;
using bandvox::Shading;

namespace {

// A row of the tables: how pictures are made.
struct Method {
    std::string name;
    Shading shading;
    int samples, resolution;  // R and N; the older methods take what they sample
    bool refine = false;
};

// Figures 1 to 5, 8 and 9, and more.
std::vector<Method> methods() {
    std::vector<Method> list;
    const std::vector<std::string>& names = bandvox::shadingNames();
    for (int i = 1; i < static_cast<int>(names.size()); ++i) {
        list.push_back({names[i], static_cast<Shading>(i), kScreen, kScreen});
    }
    for (const auto& [samples, resolution] :
         {std::pair(64, 8), {64, 16}, {64, 32}, {128, 16}, {256, 32}, {16, 16}, {32, 16}}) {
        list.push_back({"spectral", Shading::Spectral, samples, resolution});
    }
    for (const auto& [samples, resolution] : {std::pair(64, 8), {256, 32}}) {
        list.push_back({"spectral, refined", Shading::Spectral, samples, resolution, true});
    }
    return list;
}

Image draw(const Solid& solid, const Method& method) {
    const Light& light = lights()[kFront];
    if (method.shading != Shading::Spectral) {
        return voxelPicture(*solid.field, method.resolution, method.shading, light);
    }
    return spectralPicture(*solid.field,
                           {method.samples, method.resolution, kScreen, 0.5, method.refine}, light);
}

std::vector<std::string> label(const Solid& solid, const Method& method) {
    return {solid.name, method.name, std::to_string(method.samples),
            std::to_string(method.resolution)};
}

void appendErrors(std::vector<std::string>& cells, const NormalErrors& errors) {
    cells.push_back(std::to_string(errors.pixels));
    for (const double angle : {errors.mean, errors.percentile95, errors.largest}) {
        cells.push_back(errors.pixels == 0 ? "-" : fixed(angle, 3));
    }
}

// Shades a picture as a method does.
void shade(Image& image, const Solid& solid, const Method& method, const Light& light) {
    if (method.shading == Shading::Depth) {
        shadeByDepth(image, solid.field->bounds());
    } else {
        relight(image, light);
    }
}

}  // namespace

void writeMeasures(const std::filesystem::path& folder, const std::vector<Solid>& solids) {
    Table errors({"solid", "method", "R", "N", "pixels", "mean", "95 %", "largest",
                  "pixels off edges", "mean off edges", "95 % off edges", "largest off edges"});
    Table roughnesses({"solid", "method", "R", "N", "triples", "front", "front true", "upper right",
                       "upper right true"});
    for (const Solid& solid : solids) {
        TruePicture truth = truePicture(*solid.surface, kScreen, lights()[kFront]);
        for (const Method& method : methods()) {
            Image image = draw(solid, method);
            if (method.shading != Shading::Depth) {
                std::vector<std::string> cells = label(solid, method);
                appendErrors(cells, normalErrors(image, *solid.surface, 0));
                appendErrors(cells, normalErrors(image, *solid.surface, kEdgeDistance));
                errors.addRow(cells);
            }
            std::vector<std::string> cells = label(solid, method);
            for (const Light& light : lights()) {
                shade(image, solid, method, light);
                shade(truth.image, solid, method, light);
                const Roughness found = roughness(image, truth, kEdgePixels);
                if (&light == &lights().front()) cells.push_back(std::to_string(found.triples));
                cells.push_back(fixed(found.picture, 4));
                cells.push_back(fixed(found.truth, 4));
            }
            roughnesses.addRow(cells);
        }
    }
    errors.write(folder, "normal_errors");
    roughnesses.write(folder, "roughness");
}

}  // namespace paper_figures
