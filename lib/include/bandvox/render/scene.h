#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bandvox {

/// What a surface is made of: a matt ground under a coat that reflects, or glass, or something
/// between the two.
struct Material {
    openvdb::Vec3d color{0.8, 0.8, 0.8};  ///< linear, what the matt ground reflects, 0 to 1e6;
                                          ///< light only ever gets less if it is 1 at most
    double roughness = 0.3;   ///< of the coat or the glass, 0 (a mirror) to 1; the square of it is
                              ///< the width of the facets' slopes
    double reflectance = 0;   ///< of the coat seen straight on, 0 (none) to 1
    double transparency = 0;  ///< part of the surface that is glass, 0 to 1
    double refractiveIndex = 1.5;  ///< of the glass, 1 to 4
    double tintLength = 0;         ///< world units of glass after which light has become `color`; 0
                                   ///< leaves it clear
};

/// What fills a volume. Its density, times `extinction`, is the part of light that is stopped per
/// world unit.
struct Medium {
    openvdb::Vec3d color{0.9, 0.9,
                         0.9};  ///< linear, what is scattered of the light stopped, 0 to 1
    double extinction = 0;  ///< per world unit where the density is 1; 0 chooses it so that through
                            ///< the longest side of the box e^-10 is left
    double anisotropy = 0;  ///< g of the phase function, -1 (back) to 1 (onward), both excluded
    openvdb::Vec3d emission{0, 0,
                            0};  ///< linear, what so much of it that nothing passes shines with
    double glow = 1;             ///< of the temperature, if there is one: the luminance of 2000 K
};

/// A grid that is seen.
struct SceneObject {
    enum class Kind { Surface, Volume } kind = Kind::Surface;
    openvdb::FloatGrid::ConstPtr grid;    ///< density or level set; never null
    std::optional<double> iso;            ///< default: as stored, else 0.5, or 0 of a level set
    openvdb::Vec3SGrid::ConstPtr colors;  ///< where active, instead of the material's color
    openvdb::FloatGrid::ConstPtr temperatures;  ///< kelvin; of a volume that glows
    Material material;                          ///< of a surface
    Medium medium;                              ///< of a volume
    std::string name;  ///< what errors about its grids begin with, as a file's name; may be empty
};

/// A lamp.
struct Light {
    enum class Kind { Directional, Point } kind = Kind::Directional;
    openvdb::Vec3d place{-0.4, 0.7, 0.8};  ///< direction towards it, of any length, or position
    bool followsCamera = true;  ///< `place` is along the camera's right, up and back, from its eye
    openvdb::Vec3d color{0.9, 0.9, 0.9};  ///< linear; what a white matt surface that faces it looks
                                          ///< like, of a point at distance 1 world unit
    double size = 0;  ///< of its disk: degrees across (directional), radius in world units (point);
                      ///< shadows are as soft as it is large
};

/// An image of all that is around, as latitude and longitude.
class EnvironmentMap;

/// Light from everywhere.
struct Environment {
    openvdb::Vec3d color{0.1, 0.1, 0.1};  ///< linear; multiplies the map if there is one
    std::shared_ptr<const EnvironmentMap> map;
    bool visible = false;  ///< seen behind the objects
};

/// Reads an environment from an image file whose rows go from straight up (y) to straight down and
/// whose columns go around: its middle is seen along -z, its left quarter along -x. `turn`: degrees
/// to turn it around y, from above against the clock.
/// Throws Error(ErrorKind::Input) if it cannot be read.
std::shared_ptr<const EnvironmentMap> readEnvironmentMap(const std::filesystem::path& path,
                                                         double turn = 0);

/// All that a picture may show.
struct Scene {
    std::vector<SceneObject> objects;  ///< 1 to 64
    std::vector<Light> lights;
    Environment environment;
};

/// Throws Error(ErrorKind::Usage) for a value out of range, naming it.
void requireValid(const Scene& scene);
void requireValid(const Light& light);

}  // namespace bandvox
