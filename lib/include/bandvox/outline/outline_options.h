#pragma once

#include <bandvox/render/camera.h>

#include <optional>
#include <vector>

namespace bandvox {

/// What is between lines.
enum class OutlineFillKind {
    None,  ///< nothing
    Flat,  ///< one tone for each object
    Toon   ///< tones by the angle between surface and light
};

/// How surfaces are drawn as lines.
struct OutlineOptions {
    CameraOptions camera;
    double width = 200, height = 150;  ///< of the page, in any unit; > 0
    double margin = 10;                ///< of the page that stays free, if the view is fitted
    /// Distance of lines from the true ones, page units; a billionth of the longer side or more.
    double tolerance = 0.01;
    double creaseAngle = 5;     ///< least angle between normals of a crease, degrees, 0 to 180
    bool intersections = true;  ///< draw where surfaces pass through each other
    bool hidden = true;         ///< keep lines that are behind something
    /// Lines where the cosine of the angle between the normal and the direction to the light is one
    /// of these, between -1 and 1.
    std::vector<double> isophotes;
    /// Of volumes: suggestive contours, zeros of the curvature along the line of sight where that
    /// grows towards the eye by at least so much: its derivative by the way, times the square of
    /// half of the volume's diagonal. None: not drawn; else 0 or more.
    std::optional<double> suggestive;
    OutlineFillKind fill = OutlineFillKind::None;
    /// Of a toon fill: cosines of that angle at which tones change, ascending, between -1 and 1.
    std::vector<double> tones{0.25, 0.7};
    /// Direction to the light, along the camera's right, up and back, of any length but 0.
    openvdb::Vec3d light{-0.4, 0.7, 0.8};
};

}  // namespace bandvox
