#pragma once

#include <openvdb/Types.h>

#include <array>

namespace bandvox {

/// Three directions at right angles, the last of which is a normal.
class LocalFrame {
  public:
    explicit LocalFrame(const openvdb::Vec3d& normal);

    openvdb::Vec3d toLocal(const openvdb::Vec3d& v) const {
        return {v.dot(mX), v.dot(mY), v.dot(mZ)};
    }
    openvdb::Vec3d toWorld(const openvdb::Vec3d& v) const {
        return v[0] * mX + v[1] * mY + v[2] * mZ;
    }

  private:
    openvdb::Vec3d mX, mY, mZ;
};

/// Facets whose slopes are spread as T. Trowbridge and K. Reitz (1975) have it, known as GGX, with
/// B. Smith's shadowing of facets by each other. Directions are local, z along the normal, away
/// from the surface.
///
/// E. Heitz: "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs" (2014).
class Facets {
  public:
    /// `roughness`, 0 to 1: its square is the slopes' width α. From 0 up to kSmallest facets are
    /// all even.
    explicit Facets(double roughness);

    bool areEven() const { return mAlpha == 0; }

    /// How many face along `half`, per solid angle.
    double density(const openvdb::Vec3d& half) const;
    /// The part that neither `out` nor `in` is hidden from.
    double seenFromBoth(double cosOut, double cosIn) const;
    /// The same relative to the part that is seen along `out`.
    double seenFromIn(double cosOut, double cosIn) const;
    /// A facet, drawn from those seen along `out`. E. Heitz: "Sampling the GGX Distribution of
    /// Visible Normals" (2018).
    openvdb::Vec3d sample(const openvdb::Vec3d& out, const openvdb::Vec2d& u) const;

    static constexpr double kSmallest = 0.03;

  private:
    double shadowing(double cosine) const;

    double mAlpha;
};

/// What a surface reflects of unpolarized light that comes at an angle with this cosine, by
/// C. Schlick's formula (1994); `straight` is what it reflects seen straight on.
double schlick(double straight, double cosine);

/// A. Fresnel's formulas for the surface of glass. `ratio`: refractive index behind it over that
/// in front; 1 where all is reflected.
double fresnel(double cosine, double ratio);

/// The direction in which light goes on behind a facet; false if none does. `out` and `half` point
/// to the front.
bool refract(const openvdb::Vec3d& out, const openvdb::Vec3d& half, double ratio,
             openvdb::Vec3d& direction);

inline openvdb::Vec3d reflect(const openvdb::Vec3d& out, const openvdb::Vec3d& half) {
    return 2 * out.dot(half) * half - out;
}

/// What a coat of facets reflects of the light from all around, by the cosine of the line of sight,
/// and what is left for the ground under it.
///
/// C. Kelemen, L. Szirmay-Kalos: "A Microfacet Based Coupled Specular-Matte BRDF Model with
/// Importance Sampling" (2001): the ground reflects a(1 - E(o))(1 - E(i)) / (π(1 - E')), E' being
/// the mean of E, which loses nothing where a is 1 and looks the same both ways.
class CoatReflectance {
  public:
    CoatReflectance(const Facets& facets, double reflectance);

    /// E: the part that the coat reflects.
    double coat(double cosine) const;
    /// π times what the ground under the coat reflects from one direction into the other, for
    /// a = 1.
    double ground(double cosOut, double cosIn) const {
        return (1 - coat(cosOut)) * (1 - coat(cosIn)) * mScale;
    }
    /// What the ground reflects of light that comes alike from all around, for a = 1.
    double groundOfAll(double cosOut) const { return mScale > 0 ? 1 - coat(cosOut) : 0; }

  private:
    static constexpr int kSteps = 64;
    std::array<double, kSteps + 1> mCoat{};  // by cosine
    double mScale = 1;                       // 1 / (1 - E')
};

/// A direction around z, drawn by the cosine to it.
openvdb::Vec3d cosineDirection(const openvdb::Vec2d& u);

/// A place in the unit disk.
openvdb::Vec2d placeInDisk(const openvdb::Vec2d& u);

}  // namespace bandvox
