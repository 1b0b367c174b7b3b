#include "render/prepared_scene.h"

#include "render/picture_request.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandvox {

using openvdb::Vec3d;

namespace {

// How often light passes through the glass of one object on its way to a place.
constexpr int kMostPasses = 16;

}  // namespace

bool InsideOf::contains(int surface) const {
    return std::find(mSurfaces.begin(), mSurfaces.begin() + mCount, surface) !=
           mSurfaces.begin() + mCount;
}

InsideOf InsideOf::with(int surface) const {
    InsideOf more = *this;
    if (!isFull()) more.mSurfaces[more.mCount++] = static_cast<std::int8_t>(surface);
    return more;
}

InsideOf InsideOf::without(int surface) const {
    InsideOf fewer;
    for (const std::int8_t other : surfaces()) {
        if (other != surface) fewer = fewer.with(other);
    }
    return fewer;
}

PreparedScene::PreparedScene(const Scene& scene, const PictureOptions& options, Progress& progress)
    : mEnvironment(scene.environment) {
    const ProgressStage stage(progress, "preparing",
                              static_cast<std::int64_t>(scene.objects.size()));
    for (const SceneObject& object : scene.objects) {
        progress.throwIfInterrupted();
        if (options.allowEmpty && object.grid->evalActiveVoxelBoundingBox().empty()) continue;
        try {
            if (object.kind == SceneObject::Kind::Surface) {
                mSurfaces.push_back(std::make_unique<SurfaceObject>(object, options, progress));
            } else {
                mVolumes.push_back(std::make_unique<VolumeObject>(object, options, progress));
            }
        } catch (const Error& error) {
            failNamed(object, error);
        }
        progress.advance();
    }
}

Vec3d PreparedScene::environmentAlong(const Vec3d& direction) const {
    if (!mEnvironment.map) return mEnvironment.color;
    return mEnvironment.color * mEnvironment.map->radiance(direction);
}

Vec3d PreparedScene::environmentOn(const Vec3d& normal) const {
    if (!mEnvironment.map) return mEnvironment.color;
    return mEnvironment.color * mEnvironment.map->irradiance(normal);
}

std::string PreparedScene::whyEmpty() const {
    std::string all;
    const auto add = [&all](const std::string& why) {
        if (!all.empty()) all += "; ";
        all += why;
    };
    for (const auto& surface : mSurfaces) {
        if (surface->maximum() < surface->threshold()) add(surface->whyEmpty());
    }
    for (const auto& volume : mVolumes) {
        if (volume->empty()) add(volume->whyEmpty());
    }
    return "nothing to see: " + all;
}

SceneProbes PreparedScene::probes() const {
    SceneProbes probes;
    for (const auto& surface : mSurfaces) probes.surfaces.push_back(surface->probe());
    for (const auto& volume : mVolumes) probes.volumes.push_back(volume->probe());
    return probes;
}

std::optional<NearestSurface> PreparedScene::nearest(
    const Ray& ray, double end, const InsideOf& inside, SceneProbes& probes,
    std::span<const ScreenCells::Span> spans) const {
    std::optional<NearestSurface> found;
    for (int i = 0; i < static_cast<int>(mSurfaces.size()); ++i) {
        if (mSurfaces[i]->empty()) continue;
        const bool leaving = inside.contains(i);
        double from = 0, to = found ? found->hit.t : end;
        if (!spans.empty() && !leaving) {
            if (spans[i].empty()) continue;
            from = spans[i].near;
            to = std::min<double>(to, spans[i].far);
            if (from > to) continue;
        }
        const Ray part{ray.origin + from * ray.direction, ray.direction};
        auto hit = leaving ? mSurfaces[i]->exit(part, to - from, *probes.surfaces[i])
                           : mSurfaces[i]->entry(part, to - from, *probes.surfaces[i]);
        if (!hit) continue;
        hit->t += from;
        found = NearestSurface{i, *hit, leaving};
    }
    return found;
}

InsideOf PreparedScene::glassAround(const Vec3d& place, SceneProbes& probes) const {
    InsideOf inside;
    for (int i = 0; i < static_cast<int>(mSurfaces.size()); ++i) {
        const SurfaceObject& surface = *mSurfaces[i];
        if (surface.empty() || !(surface.material().transparency > 0)) continue;
        if (surface.contains(place, *probes.surfaces[i])) inside = inside.with(i);
    }
    return inside;
}

Vec3d PreparedScene::tint(int surface, double length) const {
    const Material& material = mSurfaces[surface]->material();
    if (!(material.tintLength > 0)) return Vec3d(1.0);
    const double lengths = length / material.tintLength;
    const Vec3d& color = material.color;
    return {std::pow(std::min(color[0], 1.0), lengths), std::pow(std::min(color[1], 1.0), lengths),
            std::pow(std::min(color[2], 1.0), lengths)};
}

Vec3d PreparedScene::passing(const Ray& ray, double end, const InsideOf& inside,
                             SceneProbes& probes) const {
    Vec3d left(1.0);
    for (int i = 0; i < static_cast<int>(mSurfaces.size()); ++i) {
        if (mSurfaces[i]->empty()) continue;
        left *= passing(i, ray, end, inside.contains(i), *probes.surfaces[i]);
        if (left.lengthSqr() == 0) break;
    }
    return left;
}

Vec3d PreparedScene::passing(int i, const Ray& ray, double end, bool inside,
                             DensityProbe& probe) const {
    const SurfaceObject& surface = *mSurfaces[i];
    const Material& material = surface.material();
    const double beyond = surface.beyond();
    Vec3d left(1.0);
    double t = 0;
    for (int pass = 0; pass < kMostPasses; ++pass) {
        const Ray rest{ray.origin + t * ray.direction, ray.direction};
        const auto hit =
            inside ? surface.exit(rest, end - t, probe) : surface.entry(rest, end - t, probe);
        // Without an exit before the end, the place that light comes from is in the glass.
        const double length = hit ? hit->t : end - t;
        if (inside && std::isfinite(length)) left *= tint(i, length);
        if (!hit) return left;
        if (!(material.transparency > 0)) return Vec3d(0.0);
        const double cosine = std::abs(hit->normal.dot(ray.direction));
        left *= 1 - fresnel(cosine, material.refractiveIndex);
        if (!inside) left *= material.transparency;
        inside = !inside;
        t += hit->t + beyond;
        if (t >= end) return left;
    }
    return left;
}

}  // namespace bandvox
