#pragma once

#include <bandvox/outline/outline.h>
#include <bandvox/outline/write_outline.h>

#include <array>
#include <string>
#include <vector>

namespace bandvox {

/// The lines of one object that are of one kind, all of them seen or all of them hidden.
struct PaintLayer {
    int object = 0;
    bool visible = false;
    OutlineKind kind = OutlineKind::Contour;
    std::vector<const OutlinePath*> paths;

    std::string sightName() const { return visible ? "visible" : "hidden"; }
    std::string kindName() const;
};

/// The layers of a drawing, object by object, hidden lines first, so that visible ones lie above
/// them. They refer to the drawing.
std::vector<PaintLayer> paintLayers(const Outline& outline);

/// The regions of one object, with a colour for each tone.
struct FillLayer {
    int object = 0;
    std::vector<const OutlineFill*> fills;
    std::vector<std::array<double, 3>> colors;  ///< by tone; red, green and blue, 0 to 1
};

/// The fills of a drawing, object by object. They refer to the drawing.
std::vector<FillLayer> fillLayers(const Outline& outline, const StrokeOptions& options);

/// The width of a fill's own line, page units: neighbours that only touch would let the paper
/// shine through between them.
constexpr double kFillSeam = 0.06;

/// The name of one of the outline's objects.
std::string objectName(const Outline& outline, int object);

/// "#rrggbb".
std::string hexColor(const std::array<double, 3>& color);

/// A coordinate to a tenth of a micrometre, without needless zeros.
std::string plainNumber(double value);

/// Red, green and blue, 0 to 1, of "#rgb" or "#rrggbb". Throws Error(ErrorKind::Usage) for others.
std::array<double, 3> parsedColor(const std::string& color);

/// Lengths, page units, separated by blanks or commas. Throws Error(ErrorKind::Usage) for what is
/// no list of lengths of 0 or more, not all of them 0.
std::vector<double> parsedDash(const std::string& dash);

/// Writes a text, the whole content of a file. Throws Error(ErrorKind::Runtime) if that fails.
void writeWhole(AtomicFile& file, const std::string& text);

}  // namespace bandvox
