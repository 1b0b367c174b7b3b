#pragma once

#include <bandvox/render/picture_options.h>

#include <vector>

namespace bandvox {

/// How far a filter reaches from the middle of a pixel, pixels.
double filterRadius(PixelFilter filter);

/// Draws places around a pixel's middle by a filter's weight, so that all of them count alike.
/// M. Ernst, M. Stamminger, G. Greiner: "Filter Importance Sampling" (2006).
class FilterPlaces {
  public:
    explicit FilterPlaces(PixelFilter filter);

    /// The place, pixels from the pixel's left or upper side, up to which a part `u` of the
    /// filter's weight lies.
    double operator()(double u) const;

  private:
    PixelFilter mFilter;
    double mRadius;
    std::vector<double> mWeights;  // summed up, at even steps across the filter; empty of a box
};

}  // namespace bandvox
