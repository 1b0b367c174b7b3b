#include "outline/contour_places.h"
#include "outline/draw_curves.h"
#include "outline/march_curves.h"
#include "outline/page_view.h"
#include "outline/patch_scene.h"
#include "outline/surface_curves.h"
#include "outline/volume_scene.h"
#include "render/picture_request.h"

#include <bandvox/core/error.h>
#include <bandvox/outline/volumes_to_outline.h>

#include <iterator>
#include <memory>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// A density is read to single precision at best, a patch exactly: what is seen edge-on has to be
// turned by more. At the border of the page that is a tenth of a hundredth of its size.
constexpr double kTurnOfVolumes = 3e-5;

// Of what is read between the nodes.
constexpr double kReadingTolerance = 2e-5;

std::vector<std::unique_ptr<SurfaceObject>> objectsOf(const std::vector<OutlineVolume>& volumes) {
    PictureOptions picture;
    picture.tolerance = kReadingTolerance;
    std::vector<std::unique_ptr<SurfaceObject>> objects;
    for (const OutlineVolume& volume : volumes) {
        SceneObject object;
        object.grid = volume.grid;
        object.iso = volume.iso;
        objects.push_back(std::make_unique<SurfaceObject>(object, picture));
    }
    return objects;
}

void addContent(PageContent& content, const openvdb::FloatGrid& grid) {
    const std::vector<Vec3d> points = activePoints(grid);
    content.framed.insert(content.framed.end(), points.begin(), points.end());
    for (const Vec3d& p : points) content.enclosing.push_back({p[0], p[1], p[2], 1});
}

VolumeSurface surfaceOf(const SurfaceObject& object, const ViewMatrix& view, int index) {
    const openvdb::CoordBBox box = object.grid().evalActiveVoxelBoundingBox();
    const Vec3d middle = 0.5 * (box.min().asVec3d() + box.max().asVec3d());
    const auto toWorld = object.grid().transform().baseMap()->getAffineMap()->getMat4();
    return {&object, VolumeView(view, toWorld, middle), index, middle,
            box.extents().asVec3d().length()};
}

}  // namespace

Outline volumesToOutline(const std::vector<OutlineVolume>& volumes, const PatchModel& patches,
                         const OutlineOptions& options, Progress& progress) {
    requireValid(options);
    requireFinite(patches);
    const auto objects = objectsOf(volumes);
    PageContent content = contentOf(patches.patches);
    for (const auto& object : objects) {
        if (object->empty()) throw Error(ErrorKind::Result, object->whyEmpty());
        addContent(content, object->grid());
    }
    if (content.framed.empty()) {
        throw Error(ErrorKind::Result, "the drawing is empty: there are no surfaces");
    }
    const CurveSampling sampling = samplingFor(options);
    const ViewMatrix view = pageView(content, options, kTurnOfVolumes);
    const std::vector<ViewPatch> seen = seenBy(view, patches.patches, sampling.size);
    std::vector<Curve> curves =
        surfaceCurves(patches.patches, seen, options, sampling, progress);
    std::vector<VolumeSurface> surfaces;
    for (const auto& object : objects) {
        surfaces.push_back(surfaceOf(*object, view, static_cast<int>(surfaces.size())));
    }
    const auto firstObject = static_cast<int>(patches.objects.size());
    for (const VolumeSurface& surface : surfaces) {
        const std::vector<Vec3d> places = contourPlaces(surface, progress);
        ContourEquations equations(surface);
        std::vector<Curve> contours = marchCurves(equations, places, sampling, progress);
        for (Curve& contour : contours) {
            contour.object = firstObject + surface.index;
            curves.push_back(std::move(contour));
        }
    }
    const PatchScene patchScene(seen, sampling.size);
    const VolumeScene scene(surfaces, seen.empty() ? nullptr : &patchScene);
    Outline outline = drawCurves(curves, scene, options, progress);
    outline.objects = patches.objects;
    for (const OutlineVolume& volume : volumes) outline.objects.push_back(volume.name);
    outline.warnings = patches.warnings;
    return outline;
}

}  // namespace bandvox
