#pragma once

#include "render/medium_light.h"
#include "render/prepared_scene.h"
#include "render/sample_stream.h"

#include <bandvox/render/picture_options.h>

#include <limits>
#include <optional>
#include <span>

namespace bandvox {

/// What one line of sight sees.
struct PathLight {
    openvdb::Vec3d light{0, 0, 0};  ///< without the background
    double coverage = 0;            ///< the part of the background that is hidden
    std::optional<SurfaceHit> hit;  ///< the first surface
    double depth = -1;  ///< along the ray, of volumes if no surface is hit; < 0: nothing
};

/// Follows lines of sight to where light comes from, as TransportOptions has it.
class LightPaths {
  public:
    LightPaths(const PreparedScene& scene, const Lamps& lamps, const PictureOptions& options,
               const Progress& progress);

    /// `spans`: as PreparedScene::nearest has it.
    PathLight look(const Ray& ray, std::span<const ScreenCells::Span> spans, SampleStream& numbers,
                   SceneProbes& probes) const;

  private:
    // A ray on its way back to the light.
    struct Path {
        Ray ray;
        InsideOf inside;
        int depth = 0;    // how often it has been mirrored or refracted
        int bounces = 0;  // and sent on by matt surfaces
        double reach = std::numeric_limits<double>::max();  // beyond, nothing is in its way
        double weight = 1;       // the largest part of its light that arrives
        bool isSharp = true;     // mirrored and refracted by even facets only
        bool isStraight = true;  // not mirrored: what it sees lies behind
    };
    // A place where a path meets a surface.
    struct Meeting {
        const SurfaceObject& object;
        int surface;
        openvdb::Vec3d place;
        openvdb::Vec3d normal;  // towards the path's ray
        LocalFrame frame;
        openvdb::Vec3d out;  // local, against the ray
        openvdb::Vec3d color;
    };
    // A direction to look in for light from around, local, and how much it counts.
    struct Direction {
        openvdb::Vec3d in;
        double weight;
    };
    struct Thread {
        SampleStream& numbers;
        SceneProbes& probes;
    };

    openvdb::Vec3d follow(const Path& path, Thread& thread) const;
    openvdb::Vec3d meet(const Path& path, const NearestSurface& found, Thread& thread) const;
    openvdb::Vec3d escape(const Path& path) const;
    openvdb::Vec3d matt(const Path& path, const Meeting& at, Thread& thread) const;
    Direction gatherDirection(const Meeting& at, SampleStream& numbers) const;
    openvdb::Vec3d gathered(const Path& path, const Meeting& at, Thread& thread) const;
    openvdb::Vec3d mirrored(const Path& path, const Meeting& at, Thread& thread) const;
    openvdb::Vec3d glass(const Path& path, const Meeting& at, bool leaving, Thread& thread) const;
    // `glass`: the refractive index behind its facets over that in front; none of a coat.
    openvdb::Vec3d fromLamps(const Path& path, const Meeting& at, std::optional<double> glass,
                             Thread& thread) const;
    openvdb::Vec3d seenOfLamp(const LampSample& lamp, const Path& path, const Meeting& at,
                              Thread& thread) const;
    double coatTowards(const Meeting& at, const openvdb::Vec3d& in,
                       std::optional<double> glass) const;
    Path mirror(const Path& path, const Meeting& at, const openvdb::Vec3d& half,
                double weight) const;
    double beyond(const Meeting& at) const;

    const PreparedScene& mScene;
    const Lamps& mLamps;
    MediumTransport mMedium;
    TransportOptions mTransport;
    std::optional<openvdb::Vec3d> mBackground;
};

}  // namespace bandvox
