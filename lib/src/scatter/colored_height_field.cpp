#include <bandvox/core/error.h>
#include <bandvox/scatter/colored_height_field.h>
#include <bandvox/scatter/write_surface.h>

#include <algorithm>
#include <utility>

namespace bandvox {

ColoredMesh coloredHeightField(const std::string& name, const BsplineSurface& surface,
                               std::array<int, 2> samples, int red, int column) {
    if (red < 0 || red + 3 > surface.columns()) {
        throw Error(ErrorKind::Usage, "colours are columns " + std::to_string(red) + " and two " +
                                          "more of a surface with " +
                                          std::to_string(surface.columns()) +
                                          "; expected some that are there");
    }
    SurfaceMesh field = heightFieldMesh(surface, samples, column, red);
    ColoredMesh result;
    result.name = name;
    for (openvdb::Vec3f& color : field.colors) {
        for (int c = 0; c < 3; ++c) color[c] = std::clamp(color[c], 0.0F, 1.0F);
    }
    for (const openvdb::Vec3I& triangle : field.mesh.triangles) {
        TrianglePaint& paint = result.paints.emplace_back();
        paint.texture = TrianglePaint::kNoTexture;
        for (std::size_t k = 0; k < 3; ++k) {
            paint.color[k] = field.colors[triangle[static_cast<int>(k)]];
        }
    }
    result.mesh.points = std::move(field.mesh.points);
    result.mesh.triangles = std::move(field.mesh.triangles);
    return result;
}

}  // namespace bandvox
