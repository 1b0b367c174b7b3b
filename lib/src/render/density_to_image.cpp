#include "render/picture.h"
#include "render/picture_request.h"
#include "render/surface_field.h"
#include "render/voxels_to_image.h"

#include <bandvox/core/error.h>
#include <bandvox/render/density_to_image.h>
#include <bandvox/render/scene_to_image.h>

namespace bandvox {

Scene sceneOf(const openvdb::FloatGrid::ConstPtr& grid, const RenderOptions& options) {
    SceneObject object;
    object.grid = grid;
    object.iso = options.iso;
    object.material.color = options.color;
    Light light;
    light.place = options.light;
    light.color = openvdb::Vec3d(1 - options.ambient);
    Scene scene;
    scene.objects.push_back(object);
    scene.lights.push_back(light);
    scene.environment.color = openvdb::Vec3d(options.ambient);
    return scene;
}

RenderResult densityToImage(const openvdb::FloatGrid::ConstPtr& grid, const RenderOptions& options,
                            Progress& progress) {
    requireValid(options);
    if (!grid) throw Error(ErrorKind::Input, "a picture needs a density grid, but got none");
    if (options.shading == Shading::Spectral) {
        return sceneToImage(sceneOf(grid, options), options, progress);
    }
    if (options.allowEmpty && grid->evalActiveVoxelBoundingBox().empty()) {
        return emptyPicture(options);
    }
    const DrawableGrid drawable = makeDrawable(grid, options.iso);
    worldBox(*drawable.grid);  // refuses what is not finite
    const Camera camera(options.camera, options.width, options.height,
                        activePoints(*drawable.grid));
    return voxelsToImage({*drawable.grid, drawable.iso, camera, options}, progress);
}

}  // namespace bandvox
