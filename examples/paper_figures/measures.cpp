#include "measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace paper_figures {

using bandvox::Image;
using openvdb::Vec3d;

namespace {

Vec3d vectorAt(const std::vector<float>& channel, std::size_t pixel) {
    return {channel[3 * pixel], channel[3 * pixel + 1], channel[3 * pixel + 2]};
}

}  // namespace

NormalErrors normalErrors(const Image& image, const TrueSurface& surface, double edgeDistance) {
    std::vector<double> angles;
    for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
        if (std::isinf(image.depth[pixel])) continue;
        const NearestPoint truth = surface.nearest(vectorAt(image.position, pixel));
        if (truth.edgeDistance < edgeDistance) continue;
        const Vec3d normal = vectorAt(image.normal, pixel);
        // The arc tangent keeps small angles exact.
        angles.push_back(std::atan2(normal.cross(truth.normal).length(), normal.dot(truth.normal)) *
                         180 / std::numbers::pi);
    }
    if (angles.empty()) return {};
    std::sort(angles.begin(), angles.end());
    NormalErrors errors;
    errors.pixels = angles.size();
    for (const double angle : angles) errors.mean += angle / static_cast<double>(angles.size());
    errors.percentile95 = angles[(angles.size() - 1) * 95 / 100];
    errors.largest = angles.back();
    return errors;
}

Roughness roughness(const Image& image, const TruePicture& truth, int margin) {
    const int size = image.width;
    const auto at = [&](int column, int row) {
        return static_cast<std::size_t>(row) * size + column;
    };
    const double edge = margin * kDomainSide / size;
    const auto isSeen = [&](int column, int row) {
        return column >= 0 && column < size && row >= 0 && row < size &&
               !std::isinf(image.depth[at(column, row)]) &&
               !std::isinf(truth.image.depth[at(column, row)]);
    };
    const auto isMeasured = [&](int column, int row) {
        for (int y = -margin; y <= margin; ++y) {
            for (int x = -margin; x <= margin; ++x) {
                if (x * x + y * y > margin * margin) continue;
                if (!isSeen(column + x, row + y)) return false;
            }
        }
        return truth.edgeDistance[at(column, row)] >= edge;
    };
    const auto squareAt = [](const Image& shades, std::size_t pixel) {
        const auto shade = [&](std::size_t place) -> double { return shades.color[4 * place]; };
        return std::pow(shade(pixel - 1) - 2 * shade(pixel) + shade(pixel + 1), 2);
    };
    Roughness found;
    for (int row = 0; row < size; ++row) {
        for (int column = 1; column + 1 < size; ++column) {
            if (!isMeasured(column - 1, row) || !isMeasured(column, row) ||
                !isMeasured(column + 1, row)) {
                continue;
            }
            ++found.triples;
            found.picture += squareAt(image, at(column, row));
            found.truth += squareAt(truth.image, at(column, row));
        }
    }
    if (found.triples == 0) return found;
    found.picture = std::sqrt(found.picture / static_cast<double>(found.triples));
    found.truth = std::sqrt(found.truth / static_cast<double>(found.triples));
    return found;
}

}  // namespace paper_figures
