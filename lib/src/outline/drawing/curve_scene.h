#pragma once

#include "outline/drawing/curve.h"

#include <memory>

namespace bandvox {

/// What a line of sight meets first.
struct SeenSurface {
    int object = -1;    ///< none: it meets nothing
    double z = 0;       ///< depth
    double cosine = 0;  ///< of the angle between the normal, towards the eye, and the light
};

/// Asks a scene about its curves, for one thread at a time.
class CurveReader {
  public:
    virtual ~CurveReader() = default;

    /// The exact point of a curve between two that follow each other, at a share of the way, 0
    /// to 1.
    virtual CurvePoint between(const CurvePoint& a, const CurvePoint& b, double share) = 0;

    /// How many surfaces the line of sight to a point of a curve meets before it.
    virtual int countBefore(const CurvePoint& point) = 0;

    /// A function whose sign tells on which side of a surface's fold a point of that surface lies.
    /// A curve that is no fold lies on one surface, or on a second one, too, if it `isOther`.
    virtual double foldAt(const CurvePoint& point, bool isOther) = 0;

    /// What is seen at a place of the page.
    virtual SeenSurface seenAt(double x, double y) = 0;

    /// The cosine of the angle between the light and the normal, towards the eye, of the surface
    /// that a curve's point lies on.
    virtual double cosineAt(const CurvePoint& point) = 0;
};

/// The surfaces that curves lie on and that hide them. Many threads may ask for readers at once,
/// which answer alike; a scene has to outlive them.
class CurveScene {
  public:
    virtual ~CurveScene() = default;
    virtual std::unique_ptr<CurveReader> reader() const = 0;
};

}  // namespace bandvox
