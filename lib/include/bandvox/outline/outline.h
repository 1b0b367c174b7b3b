#pragma once

#include <array>
#include <string>
#include <vector>

namespace bandvox {

/// What a line of a drawing is.
enum class OutlineKind {
    Contour,       ///< where a surface turns away from the eye
    Boundary,      ///< where a surface ends
    Crease,        ///< where two patches meet at an angle
    Intersection,  ///< where surfaces pass through each other
    Isophote,      ///< of one angle between a surface and the light
    Suggestive     ///< where a surface would turn away from an eye a little aside
};

/// A line of a drawing: cubic Bézier curves, one after the other.
struct OutlinePath {
    OutlineKind kind = OutlineKind::Contour;
    int object = 0;  ///< of the model's objects
    int hidden = 0;  ///< surfaces in front of it; 0: it is seen
    bool closed = false;
    /// Places of the page, its units, y downward: an anchor, and for each curve two handles and
    /// the next anchor. The last one is the first one again if the path is closed.
    std::vector<std::array<double, 2>> points;

    std::size_t anchors() const { return points.size() / 3 + (closed ? 0 : 1); }
};

/// A region of a drawing in which one object is seen, in one tone.
struct OutlineFill {
    int object = 0;  ///< of the model's objects
    int tone = 0;    ///< 0: the darkest; as many as OutlineOptions::tones is the lightest
    /// Its borders, as closed paths' points: what an odd number of them surrounds is inside.
    /// Neighbours have the same curves where they meet.
    std::vector<std::vector<std::array<double, 2>>> loops;
};

/// A drawing of lines, and of regions under them.
struct Outline {
    double width = 0, height = 0;  ///< of the page
    std::vector<std::string> objects;
    std::vector<OutlinePath> paths;
    std::vector<OutlineFill> fills;  ///< they do not overlap
    int tones = 1;                   ///< that fills may have
    std::vector<std::string> warnings;
};

}  // namespace bandvox
