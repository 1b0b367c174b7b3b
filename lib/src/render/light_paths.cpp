#include "render/light_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox {

using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

namespace {

constexpr double kFar = std::numeric_limits<double>::max();

// Paths that carry less than this end.
constexpr double kLeastWeight = 1e-3;

// So often both ways at glass are followed, and from then on one of them.
constexpr int kSplits = 3;

// Below this cosine a line of sight is along the surface.
constexpr double kLeastCosine = 1e-4;

double largest(const Vec3d& v) {
    return std::max({v[0], v[1], v[2]});
}

}  // namespace

LightPaths::LightPaths(const PreparedScene& scene, const Lamps& lamps,
                       const PictureOptions& options, const Progress& progress)
    : mScene(scene),
      mLamps(lamps),
      mMedium(scene, lamps, options, progress),
      mTransport(options.transport),
      mBackground(options.background) {}

PathLight LightPaths::look(const Ray& ray, std::span<const ScreenCells::Span> spans,
                           SampleStream& numbers, SceneProbes& probes) const {
    Thread thread{numbers, probes};
    Path path{ray, mScene.glassAround(ray.origin, probes)};
    PathLight seen;
    const auto found = mScene.nearest(ray, kFar, path.inside, probes, spans);
    const double end = found ? found->hit.t : kFar;
    const MediumLight medium = mMedium.along(ray, end, path.inside, numbers, probes);
    seen.light = medium.light;
    if (found) {
        path.weight = medium.left;
        Vec3d behind = meet(path, *found, thread);
        for (const std::int8_t glass : path.inside.surfaces()) behind *= mScene.tint(glass, end);
        seen.light += medium.left * behind;
        seen.coverage = 1;
        seen.hit = found->hit;
        seen.depth = end;
    } else if (mScene.environment().visible) {
        seen.light += medium.left * mScene.environmentAlong(ray.direction);
        seen.coverage = 1;
    } else {
        seen.coverage = 1 - medium.left;
    }
    if (!found && medium.left < 1) seen.depth = medium.depth;
    return seen;
}

Vec3d LightPaths::follow(const Path& path, Thread& thread) const {
    if (path.depth > mTransport.depth || path.weight < kLeastWeight) return Vec3d(0.0);
    const auto found = mScene.nearest(path.ray, path.reach, path.inside, thread.probes);
    const double end = found ? found->hit.t : path.reach;
    const MediumLight medium =
        mMedium.along(path.ray, end, path.inside, thread.numbers, thread.probes);
    Vec3d light = found ? meet(path, *found, thread) : escape(path);
    if (found) {
        for (const std::int8_t glass : path.inside.surfaces()) light *= mScene.tint(glass, end);
    }
    return medium.light + medium.left * light;
}

Vec3d LightPaths::escape(const Path& path) const {
    if (path.isStraight && mBackground && !mScene.environment().visible) return *mBackground;
    const Vec3d around = mScene.environmentAlong(path.ray.direction);
    // Where facets are not even, lamps have been looked for already.
    return path.isSharp && path.bounces == 0 ? around + mLamps.seenAlong(path.ray.direction)
                                             : around;
}

Vec3d LightPaths::meet(const Path& path, const NearestSurface& found, Thread& thread) const {
    const SurfaceObject& object = *mScene.surfaces()[found.surface];
    const Vec3d place = path.ray.origin + found.hit.t * path.ray.direction;
    const Vec3d normal = found.leaving ? -found.hit.normal : found.hit.normal;
    const LocalFrame frame(normal);
    Vec3d out = frame.toLocal(-path.ray.direction);
    out[2] = std::max(out[2], kLeastCosine);
    const Meeting at{object,     found.surface,        place, normal, frame,
                     out.unit(), object.colorAt(place)};
    const double transparency = object.material().transparency;
    Vec3d light(0.0);
    if (transparency < 1 && !found.leaving) {
        Path rest = path;
        rest.weight *= 1 - transparency;
        light += (1 - transparency) * matt(rest, at, thread);
        if (object.material().reflectance > 0) {
            light += (1 - transparency) * mirrored(rest, at, thread);
        }
    }
    if (transparency > 0) {
        // From inside there is no matt surface that light could meet.
        const double part = found.leaving ? 1 : transparency;
        Path rest = path;
        rest.weight *= part;
        light += part * glass(rest, at, found.leaving, thread);
    }
    return light;
}

double LightPaths::beyond(const Meeting& at) const {
    return at.object.beyond();
}

// The matt ground, and what the coat shows of the lamps.
Vec3d LightPaths::matt(const Path& path, const Meeting& at, Thread& thread) const {
    Vec3d light = fromLamps(path, at, std::nullopt, thread);
    if (mTransport.gather > 0) return light + gathered(path, at, thread);
    return light +
           at.color * at.object.coat().groundOfAll(at.out[2]) * mScene.environmentOn(at.normal);
}

Vec3d LightPaths::fromLamps(const Path& path, const Meeting& at, std::optional<double> glass,
                            Thread& thread) const {
    Vec3d light(0.0);
    for (int i = 0; i < mLamps.count(); ++i) {
        const LampSample lamp = mLamps.sample(i, at.place, thread.numbers.next2());
        const Vec3d in = at.frame.toLocal(lamp.direction);
        if (!(in[2] > 0)) continue;
        Vec3d part = Vec3d(pi * coatTowards(at, in, glass));
        if (!glass) part += at.color * at.object.coat().ground(at.out[2], in[2]);
        if (largest(part) > 0) light += in[2] * part * seenOfLamp(lamp, path, at, thread);
    }
    return light;
}

// What facets send of light that comes from one direction, per solid angle.
double LightPaths::coatTowards(const Meeting& at, const Vec3d& in,
                               std::optional<double> glass) const {
    const Material& material = at.object.material();
    const Facets& facets = at.object.facets();
    if (facets.areEven() || (!glass && !(material.reflectance > 0))) return 0;
    const Vec3d half = (at.out + in).unit();
    const double cosine = at.out.dot(half);
    const double reflected =
        glass ? fresnel(cosine, *glass) : schlick(material.reflectance, cosine);
    return reflected * facets.density(half) * facets.seenFromBoth(at.out[2], in[2]) /
           (4 * at.out[2] * in[2]);
}

// The light of a lamp that reaches a place.
Vec3d LightPaths::seenOfLamp(const LampSample& lamp, const Path& path, const Meeting& at,
                             Thread& thread) const {
    const Ray ray{at.place + beyond(at) * at.normal, lamp.direction};
    Vec3d light = lamp.color;
    if (mTransport.shadows) {
        light *= mScene.passing(ray, lamp.distance, path.inside, thread.probes);
        if (light.lengthSqr() > 0) {
            light *= mMedium.left(ray, lamp.distance, thread.numbers, thread.probes);
        }
    }
    return light;
}

// A direction to look in, drawn by the cosine, or half of the time by the brightness of what is
// around; weighted by the balance heuristic of E. Veach (1997).
LightPaths::Direction LightPaths::gatherDirection(const Meeting& at, SampleStream& numbers) const {
    const auto& map = mScene.environment().map;
    if (!map) return {cosineDirection(numbers.next2()), 1};
    const bool byCosine = numbers.next() < 0.5;
    const Vec2d u = numbers.next2();
    const Vec3d in = byCosine ? cosineDirection(u) : at.frame.toLocal(map->sample(u).direction);
    if (!(in[2] > 0)) return {in, 0};
    const double cosine = in[2] / pi;
    return {in, cosine / (0.5 * cosine + 0.5 * map->density(at.frame.toWorld(in)))};
}

// Light from around on the matt ground, as far as nothing is in the way.
Vec3d LightPaths::gathered(const Path& path, const Meeting& at, Thread& thread) const {
    const bool goesOn = path.bounces < mTransport.bounces;
    const double end = mTransport.gatherDistance > 0 ? mTransport.gatherDistance : kFar;
    // One direction is enough for each of the many that other surfaces look in.
    const int count = path.bounces == 0 ? mTransport.gather : 1;
    Vec3d sum(0.0);
    for (int i = 0; i < count; ++i) {
        SampleStream numbers = thread.numbers.branch(i);
        Thread own{numbers, thread.probes};
        const auto [in, weight] = gatherDirection(at, numbers);
        if (!(weight > 0)) continue;
        const Ray ray{at.place + beyond(at) * at.normal, at.frame.toWorld(in)};
        Vec3d light(0.0);
        if (goesOn) {
            Path next{ray, path.inside};
            next.depth = path.depth;
            next.bounces = path.bounces + 1;
            next.reach = end;
            next.weight = path.weight;
            next.isSharp = next.isStraight = false;
            light = follow(next, own);
        } else {
            light = mScene.environmentAlong(ray.direction);
            if (light.lengthSqr() > 0) {
                light *= mScene.passing(ray, end, path.inside, own.probes);
            }
            if (light.lengthSqr() > 0) light *= mMedium.left(ray, end, numbers, own.probes);
        }
        sum += weight * at.object.coat().ground(at.out[2], in[2]) * light;
    }
    // Take other numbers from here on.
    thread.numbers = thread.numbers.branch(count);
    return at.color * sum / count;
}

LightPaths::Path LightPaths::mirror(const Path& path, const Meeting& at, const Vec3d& half,
                                    double weight) const {
    Path next = path;
    next.ray = {at.place + beyond(at) * at.normal, at.frame.toWorld(reflect(at.out, half)).unit()};
    next.depth = path.depth + 1;
    next.reach = kFar;
    next.weight = path.weight * weight;
    next.isSharp = path.isSharp && at.object.facets().areEven();
    next.isStraight = false;
    return next;
}

// What the coat shows of what is around.
Vec3d LightPaths::mirrored(const Path& path, const Meeting& at, Thread& thread) const {
    const Facets& facets = at.object.facets();
    const Vec3d half = facets.sample(at.out, thread.numbers.next2());
    const Vec3d in = reflect(at.out, half);
    if (!(in[2] > 0)) return Vec3d(0.0);
    const double weight = schlick(at.object.material().reflectance, at.out.dot(half)) *
                          facets.seenFromIn(at.out[2], in[2]);
    return weight * follow(mirror(path, at, half, weight), thread);
}

Vec3d LightPaths::glass(const Path& path, const Meeting& at, bool leaving, Thread& thread) const {
    const double index = at.object.material().refractiveIndex;
    // The glass on the other side of the surface, or air.
    double outside = 1;
    for (const std::int8_t other : path.inside.surfaces()) {
        if (other != at.surface) {
            outside = mScene.surfaces()[other]->material().refractiveIndex;
        }
    }
    const double ratio = leaving ? outside / index : index / outside;
    const Facets& facets = at.object.facets();
    const Vec3d half = facets.sample(at.out, thread.numbers.next2());
    const double cosine = std::max(at.out.dot(half), kLeastCosine);
    const double reflected = fresnel(cosine, ratio);

    Vec3d light = leaving ? Vec3d(0.0) : fromLamps(path, at, ratio, thread);
    const bool both = path.depth < kSplits && path.bounces == 0;
    const bool chooseMirror = !both && thread.numbers.next() < reflected;

    const Vec3d in = reflect(at.out, half);
    if ((both || chooseMirror) && reflected > 0 && in[2] > 0) {
        const double seen = facets.seenFromIn(at.out[2], in[2]);
        const double weight = (both ? reflected : 1) * seen;
        light += weight * follow(mirror(path, at, half, both ? weight : seen), thread);
    }
    Vec3d through;
    if ((both || !chooseMirror) && reflected < 1 && refract(at.out, half, ratio, through) &&
        through[2] < 0) {
        const double seen = facets.seenFromIn(at.out[2], -through[2]);
        const double weight = (both ? 1 - reflected : 1) * seen;
        Path next = path;
        next.ray = {at.place - beyond(at) * at.normal, at.frame.toWorld(through).unit()};
        next.inside = leaving ? path.inside.without(at.surface) : path.inside.with(at.surface);
        next.depth = path.depth + 1;
        next.reach = kFar;
        next.weight = path.weight * (both ? weight : seen);
        next.isSharp = path.isSharp && facets.areEven();
        light += weight * follow(next, thread);
    }
    return light;
}

}  // namespace bandvox
