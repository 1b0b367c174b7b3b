#include "render/lamps.h"

#include "render/facets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bandvox {

using openvdb::Vec2d;
using openvdb::Vec3d;
using std::numbers::pi;

namespace {

// Half the angle that a directional lamp is across, radians.
double halfAngle(const Light& light) {
    return 0.5 * light.size * pi / 180;
}

}  // namespace

Lamps::Lamps(const std::vector<Light>& lights, const Camera& camera) : mLights(lights) {
    for (Light& light : mLights) {
        const bool isPoint = light.kind == Light::Kind::Point;
        if (light.followsCamera) {
            const Vec3d place = light.place;
            light.place = place[0] * camera.right() + place[1] * camera.upward() -
                          place[2] * camera.forward();
            if (isPoint) light.place += camera.eye();
        }
        if (!isPoint) light.place.normalize();
    }
}

LampSample Lamps::sample(int i, const Vec3d& place, const Vec2d& u) const {
    const Light& light = mLights[i];
    const Vec2d disk = placeInDisk(u);
    if (light.kind == Light::Kind::Directional) {
        LampSample sample{light.place, std::numeric_limits<double>::infinity(), light.color};
        if (light.size > 0) {
            // Equal areas of the disk are equal solid angles if the height above falls with the
            // square of the radius.
            const double depth = (1 - std::cos(halfAngle(light))) * disk.lengthSqr();
            const double radius = std::sqrt(std::max(2 - depth, 0.0));
            const double scale = std::sqrt(1 - std::cos(halfAngle(light)));
            sample.direction =
                LocalFrame(light.place)
                    .toWorld({scale * radius * disk[0], scale * radius * disk[1], 1 - depth});
        }
        return sample;
    }
    Vec3d offset = light.place - place;
    double distance = offset.length();
    if (light.size > 0 && distance > 0) {
        offset += light.size * LocalFrame(offset / distance).toWorld({disk[0], disk[1], 0});
        distance = offset.length();
    }
    if (!(distance > 0)) return {{0, 0, 1}, 0, Vec3d(0.0)};
    return {offset / distance, distance, light.color / (distance * distance)};
}

Vec3d Lamps::seenAlong(const Vec3d& direction) const {
    Vec3d sum(0.0);
    for (const Light& light : mLights) {
        if (light.kind != Light::Kind::Directional || !(light.size > 0)) continue;
        const double edge = std::cos(halfAngle(light));
        // Its light, spread over its disk: on a surface that faces it π times the colour.
        const double sine = std::sin(0.5 * halfAngle(light));
        if (direction.dot(light.place) >= edge) sum += light.color / (4 * sine * sine);
    }
    return sum;
}

}  // namespace bandvox
