#include "outline/volumes/volume_drawing.h"

#include "outline/drawing/draw_curves.h"
#include "outline/drawing/page_view.h"
#include "outline/drawing/slivers.h"
#include "outline/patches/surface_curves.h"
#include "outline/volumes/curve_places.h"
#include "outline/volumes/march_curves.h"
#include "outline/volumes/pierced_patches.h"
#include "outline/volumes/suggestive_equations.h"
#include "render/picture_request.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace bandvox {
namespace {

using openvdb::Vec3d;

// A density is known to a millionth or so, a patch exactly: so that nothing is seen edge-on it has
// to be turned by more. The nearest and the farthest lines move by so much of half of the page.
constexpr double kTurnOfVolumes = 5e-5;

// Of what is read between the nodes. Beyond it gradients jump from voxel to voxel, and with them
// contours of what is nearly flat.
constexpr double kReadingTolerance = 2e-6;

std::vector<std::unique_ptr<SurfaceObject>> objectsOf(const std::vector<OutlineVolume>& volumes) {
    PictureOptions picture;
    picture.tolerance = kReadingTolerance;
    picture.readsFinely = true;
    std::vector<std::unique_ptr<SurfaceObject>> objects;
    for (const OutlineVolume& volume : volumes) {
        if (volume.grid && volume.grid->evalActiveVoxelBoundingBox().empty()) {
            throw Error(ErrorKind::Result, "the drawing is empty: the grid \"" +
                                               volume.grid->getName() + "\" has no active voxel");
        }
        SceneObject object;
        object.grid = volume.grid;
        object.iso = volume.iso;
        objects.push_back(std::make_unique<SurfaceObject>(object, picture));
        if (objects.back()->empty()) {
            throw Error(ErrorKind::Result, "nothing to see: " + objects.back()->whyEmpty());
        }
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

struct CurveRequest {
    const OutlineOptions& options;
    Vec3d light;  // world, length 1
    const CurveSampling& sampling;
    const std::vector<VolumeSurface>& surfaces;
};

std::vector<Curve> followed(const VolumeSurface& surface, const EquationsMaker& equations,
                            const CurveSampling& sampling, Progress& progress) {
    const std::vector<Vec3d> places = curvePlaces(surface, equations, progress);
    return marchCurves(*equations(), places, sampling, progress);
}

// Suggestive contours that are shorter than a hundredth of the page only tell of roughness.
bool isLong(const Curve& curve, const CurveSampling& sampling) {
    double length = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        length += std::hypot(curve.points[i].x - curve.points[i - 1].x,
                             curve.points[i].y - curve.points[i - 1].y);
    }
    return length > 0.01 * sampling.size;
}

// Contours, isophotes, and intersections with the volumes after this one.
std::vector<Curve> curvesOn(const VolumeSurface& surface, const CurveRequest& request,
                            Progress& progress) {
    const CurveSampling& sampling = request.sampling;
    const double width = std::max(2 * sampling.flatness, kTurnOfVolumes * sampling.size);
    std::vector<Curve> curves =
        withoutSlivers(followed(
                           surface, [&] { return std::make_unique<ContourEquations>(surface); },
                           sampling, progress),
                       width);
    const auto add = [&](OutlineKind kind, const EquationsMaker& equations) {
        for (Curve& curve : followed(surface, equations, sampling, progress)) {
            curve.kind = kind;
            curves.push_back(std::move(curve));
        }
    };
    for (const double cosine : allIsophotes(request.options)) {
        add(OutlineKind::Isophote,
            [&] { return std::make_unique<IsophoteEquations>(surface, request.light, cosine); });
    }
    if (request.options.suggestive) {
        add(OutlineKind::Suggestive, [&] {
            return std::make_unique<SuggestiveEquations>(surface, *request.options.suggestive);
        });
        std::erase_if(curves, [&](const Curve& curve) {
            return curve.kind == OutlineKind::Suggestive && !isLong(curve, sampling);
        });
    }
    const bool isFilled = request.options.fill != OutlineFillKind::None;
    if (!request.options.intersections && !isFilled) return curves;
    for (const VolumeSurface& other : request.surfaces) {
        if (other.index <= surface.index) continue;
        add(OutlineKind::Intersection,
            [&] { return std::make_unique<MeetingEquations>(surface, other); });
    }
    return curves;
}

}  // namespace

VolumeDrawing::VolumeDrawing(const std::vector<OutlineVolume>& volumes, const PatchModel& patches,
                             const OutlineOptions& options, Progress& progress)
    : mObjects(objectsOf(volumes)) {
    PageContent content = contentOf(patches.patches);
    for (const auto& object : mObjects) addContent(content, object->grid());
    if (content.framed.empty()) {
        throw Error(ErrorKind::Result, "the drawing is empty: there are no surfaces");
    }
    const CurveSampling sampling = samplingFor(options);
    const ViewMatrix view = pageView(content, options, kTurnOfVolumes);
    mPatches = seenBy(view, patches.patches, sampling.size);
    mFaces = FaceRegions(patches.topology);
    mLit = {patches.patches, mPatches, lightDirection(content, options),
            patches.topology.faces.empty() ? nullptr : &mFaces};
    mCurves = surfaceCurves(mLit, options, sampling, progress);
    for (const auto& object : mObjects) {
        mSurfaces.push_back(surfaceOf(*object, view, static_cast<int>(mSurfaces.size())));
    }
    const Vec3d light(mLit.light[0], mLit.light[1], mLit.light[2]);
    const auto firstObject = static_cast<int>(patches.objects.size());
    for (const VolumeSurface& surface : mSurfaces) {
        for (Curve& curve : curvesOn(surface, {options, light, sampling, mSurfaces}, progress)) {
            curve.object = firstObject + surface.index;
            mCurves.push_back(std::move(curve));
        }
    }
    const bool isFilled = options.fill != OutlineFillKind::None;
    if (!mPatches.empty() && (options.intersections || isFilled)) {
        for (const VolumeSurface& surface : mSurfaces) {
            std::vector<Curve> curves = piercingCurves(mLit, surface, sampling, progress);
            std::move(curves.begin(), curves.end(), std::back_inserter(mCurves));
        }
    }
    if (!mPatches.empty()) mPatchScene = std::make_unique<PatchScene>(mLit, sampling.size);
    mScene = std::make_unique<VolumeScene>(mSurfaces, mPatchScene.get(), mLit, firstObject);
}

}  // namespace bandvox
