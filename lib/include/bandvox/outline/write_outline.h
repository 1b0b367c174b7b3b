#pragma once

#include <bandvox/core/atomic_file.h>
#include <bandvox/outline/outline.h>

#include <string>
#include <vector>

namespace bandvox {

/// How lines and fills look in a file.
struct StrokeOptions {
    double width = 0.35;            ///< of visible lines, page units; 0.0001 or more
    double hiddenWidth = 0.18;      ///< of hidden ones
    std::string color = "#000000";  ///< as CSS has it
    std::string hiddenColor = "#808080";
    std::string dash = "1.2 0.8";  ///< of hidden lines, lengths of line and gap, page units
    /// Of fills in their lightest tone, "#rgb" or "#rrggbb", at least one: the first object has the
    /// first colour, and so on, and over again.
    std::vector<std::string> fillColors{"#f2d399", "#a8c8dc", "#c9dba4", "#e3b1a6", "#cdbfe0"};
    double shade = 0.45;  ///< of the darkest tone, a part of that colour, 0 to 1
};

/// Throws Error(ErrorKind::Usage) for widths, a dash or a shade out of range, and for fill colours
/// that are none. Colours of lines may be words of CSS, for SVG.
void requireValid(const StrokeOptions& options);

/// Throws Error(ErrorKind::Usage) for colours of lines other than "#rgb" and "#rrggbb", which all
/// formats but SVG need.
void requireHexColors(const StrokeOptions& options);

/// Writes a drawing as SVG: width and height in millimetres, with a matching viewBox. Each object
/// is a group of layers, one for each kind of line that it has, visible and hidden ones apart, with
/// a class for style sheets; ids do not depend on anything but the drawing. Lines are paths of
/// cubic curves, and nothing is clipped.
///
/// Throws as requireValid, Error(ErrorKind::Runtime) if it cannot be written.
void writeSvg(AtomicFile& file, const Outline& outline, const StrokeOptions& options = {});

/// Writes a drawing as PDF 1.7, a page unit a millimetre, with a layer (optional content) for each
/// object and kind of line, visible and hidden ones apart. Colours are "#rgb" or "#rrggbb".
///
/// Throws as requireValid, Error(ErrorKind::Usage) for other colours, Error(ErrorKind::Runtime) if
/// it cannot be written.
void writePdf(AtomicFile& file, const Outline& outline, const StrokeOptions& options = {});

/// The same as Encapsulated PostScript, which has no layers.
void writeEps(AtomicFile& file, const Outline& outline, const StrokeOptions& options = {});

/// Writes the lines of a drawing as splines of a DXF file (AutoCAD 2004), a unit a millimetre, y
/// upward, with the layers of a PDF. Widths are the nearest ones that the format has.
///
/// Throws as writePdf, also Error(ErrorKind::Usage) for a drawing with fills.
void writeDxf(AtomicFile& file, const Outline& outline, const StrokeOptions& options = {});

/// The extensions of the files above: .svg, .pdf, .eps, .dxf.
const std::vector<std::string>& outlineExtensions();

/// Writes a drawing as the extension of the file's target tells. Throws as the functions above,
/// Error(ErrorKind::Usage) for another extension.
void writeOutline(AtomicFile& file, const Outline& outline, const StrokeOptions& options = {});

}  // namespace bandvox
