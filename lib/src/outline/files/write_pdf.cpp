// Adobe's Portable Document Format 1.7 (ISO 32000-1:2008), as far as lines and layers need it, and
// Encapsulated PostScript.

#include "outline/files/paint_layers.h"

#include <array>
#include <cstddef>

namespace bandvox {
namespace {

constexpr double kPointsPerUnit = 72 / 25.4;  // a page unit is a millimetre

// The words for the operators that both languages have.
struct Operators {
    const char *move, *curve, *close, *stroke, *color, *width, *dash;
    const char *fillColor, *fill;  // fill, by the rule of odd and even, and stroke
};
constexpr Operators kPdf{"m", "c", "h", "S", "RG", "w", "d", "rg", "B*"};
constexpr Operators kPostScript{"moveto",  "curveto",     "closepath",
                                "stroke",  "setrgbcolor", "setlinewidth",
                                "setdash", "setrgbcolor", "gsave eofill grestore stroke"};

void appendNumbers(std::string& text, const std::array<double, 2>& numbers) {
    for (const double number : numbers) text += plainNumber(number) + " ";
}

// Curves of a path. The page's y goes up, and the drawing's down.
void appendCurves(std::string& text, const std::vector<std::array<double, 2>>& points,
                  double height, const Operators& words) {
    const auto put = [&](const std::array<double, 2>& p) {
        appendNumbers(text, {p[0], height - p[1]});
    };
    put(points[0]);
    text += words.move;
    text += '\n';
    for (std::size_t i = 1; i + 2 < points.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) put(points[i + k]);
        text += words.curve;
        text += '\n';
    }
}

void appendFills(std::string& text, const FillLayer& layer, double height, const Operators& words) {
    text += plainNumber(kFillSeam) + " ";
    text += words.width;
    text += " [] 0 ";
    text += words.dash;
    text += '\n';
    for (const OutlineFill* fill : layer.fills) {
        for (const char* word : {words.fillColor, words.color}) {
            for (const double c : layer.colors[static_cast<std::size_t>(fill->tone)]) {
                text += plainNumber(c) + " ";
            }
            text += word;
            text += '\n';
        }
        for (const auto& loop : fill->loops) {
            appendCurves(text, loop, height, words);
            text += words.close;
            text += '\n';
        }
        text += words.fill;
        text += '\n';
    }
}

// Lines of a layer.
void appendLines(std::string& text, const PaintLayer& layer, double height,
                 const StrokeOptions& options, const Operators& words) {
    const auto [r, g, b] = parsedColor(layer.visible ? options.color : options.hiddenColor);
    for (const double c : {r, g, b}) text += plainNumber(c) + " ";
    text += words.color;
    text += ' ' + plainNumber(layer.visible ? options.width : options.hiddenWidth);
    text += ' ';
    text += words.width;
    text += " [";
    if (!layer.visible) {
        for (const double length : parsedDash(options.dash)) text += plainNumber(length) + " ";
    }
    text += "] 0 ";
    text += words.dash;
    text += '\n';
    for (const OutlinePath* path : layer.paths) {
        appendCurves(text, path->points, height, words);
        if (path->closed) {
            text += words.close;
            text += ' ';
        }
        text += words.stroke;
        text += '\n';
    }
}

// A text string: characters beyond ASCII, and those that would end it, become underscores.
std::string pdfText(const std::string& text) {
    std::string result = "(";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        const bool isPlain = code >= 0x20 && code < 0x7F && c != '(' && c != ')' && c != '\\';
        result += isPlain ? c : '_';
    }
    return result + ")";
}

/// Numbers objects as they are added, and knows where each of them begins.
class PdfObjects {
  public:
    // Appends the next object; returns its number.
    std::size_t add(const std::string& content) {
        mStarts.push_back(mText.size());
        mText += std::to_string(mStarts.size()) + " 0 obj\n";
        mText += content + "\nendobj\n";
        return mStarts.size();
    }

    std::string finish(std::size_t root) {
        const std::size_t table = mText.size();
        const std::string count = std::to_string(mStarts.size() + 1);
        mText += "xref\n0 " + count;
        mText += "\n0000000000 65535 f \n";
        for (const std::size_t start : mStarts) {
            const std::string digits = std::to_string(start);
            mText += std::string(digits.size() < 10 ? 10 - digits.size() : 0, '0') + digits;
            mText += " 00000 n \n";
        }
        mText += "trailer\n<< /Size " + count;
        mText += " /Root " + std::to_string(root);
        mText += " 0 R >>\nstartxref\n" + std::to_string(table);
        mText += "\n%%EOF\n";
        return std::move(mText);
    }

  private:
    std::string mText = "%PDF-1.7\n%\xE2\xE3\xCF\xD3\n";
    std::vector<std::size_t> mStarts;
};

std::string reference(std::size_t object) {
    return std::to_string(object) + " 0 R";
}

}  // namespace

void writePdf(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    requireValid(options);
    PdfObjects objects;
    const std::string scale = plainNumber(kPointsPerUnit);
    std::string content = "q 1 J 1 j " + scale;
    content += " 0 0 " + scale;
    content += " 0 0 cm\n";
    std::string properties, order;
    const auto beginLayer = [&](const std::string& name) {
        const std::size_t group = objects.add("<< /Type /OCG /Name " + pdfText(name) + " >>");
        const std::string label = "/L" + std::to_string(group);
        properties += label + " ";
        properties += reference(group) + " ";
        order += reference(group) + " ";
        content += "/OC " + label;
        content += " BDC\n";
    };
    for (const FillLayer& layer : fillLayers(outline, options)) {
        beginLayer(objectName(outline, layer.object) + ": fill");
        appendFills(content, layer, outline.height, kPdf);
        content += "EMC\n";
    }
    for (const PaintLayer& layer : paintLayers(outline)) {
        std::string name = objectName(outline, layer.object);
        name += ": " + layer.sightName();
        name += " " + layer.kindName();
        beginLayer(name);
        appendLines(content, layer, outline.height, options, kPdf);
        content += "EMC\n";
    }
    content += "Q";
    std::string stream = "<< /Length " + std::to_string(content.size());
    stream += " >>\nstream\n" + content;
    stream += "\nendstream";
    const std::size_t drawing = objects.add(stream);
    // The page refers to the list of pages, which comes next.
    std::string page = "<< /Type /Page /Parent " + reference(drawing + 2);
    page += " /MediaBox [0 0 " + plainNumber(outline.width * kPointsPerUnit);
    page += " " + plainNumber(outline.height * kPointsPerUnit);
    page += "] /Contents " + reference(drawing);
    page += " /Resources << /Properties << " + properties;
    page += ">> >> >>";
    const std::size_t first = objects.add(page);
    const std::size_t pages =
        objects.add("<< /Type /Pages /Count 1 /Kids [" + reference(first) + "] >>");
    std::string catalog = "<< /Type /Catalog /Pages " + reference(pages);
    catalog += " /OCProperties << /OCGs [" + order;
    catalog += "] /D << /Order [" + order;
    catalog += "] >> >> >>";
    const std::size_t root = objects.add(catalog);
    writeWhole(file, objects.finish(root));
}

void writeEps(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    requireValid(options);
    const double width = outline.width * kPointsPerUnit, height = outline.height * kPointsPerUnit;
    std::string text = "%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 ";
    text += std::to_string(static_cast<long>(width) + 1) + " ";
    text += std::to_string(static_cast<long>(height) + 1) + "\n%%HiResBoundingBox: 0 0 ";
    text += plainNumber(width) + " ";
    text += plainNumber(height) + "\n%%EndComments\ngsave\n";
    const std::string scale = plainNumber(kPointsPerUnit);
    text += scale + " ";
    text += scale + " scale 1 setlinecap 1 setlinejoin\n";
    for (const FillLayer& layer : fillLayers(outline, options)) {
        text += "% fill\n";
        appendFills(text, layer, outline.height, kPostScript);
    }
    for (const PaintLayer& layer : paintLayers(outline)) {
        text += "% " + layer.sightName();
        text += " " + layer.kindName();
        text += "\n";
        appendLines(text, layer, outline.height, options, kPostScript);
    }
    text += "grestore\n%%EOF\n";
    writeWhole(file, text);
}

}  // namespace bandvox
