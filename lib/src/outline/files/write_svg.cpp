#include "outline/files/paint_layers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace bandvox {
namespace {

// The length of the character that a text in UTF-8 begins with; 0 if it is none that XML may have.
std::size_t characterLength(std::string_view text) {
    const auto byte = [&](std::size_t i) -> std::uint32_t {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    };
    const std::uint32_t first = byte(0);
    if (first < 0x80) return first < 0x20 || first == 0x7F ? 0 : 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4) return 0;
    std::uint32_t code = first & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) return 0;
        code = code << 6U | (byte(i) & 0x3FU);
    }
    constexpr std::array<std::uint32_t, 5> kFirstOf{0, 0, 0x80, 0x800, 0x10000};
    const bool isSurrogate = code >= 0xD800 && code < 0xE000;
    const bool isCharacter = code >= kFirstOf[length] && code <= 0x10FFFF && !isSurrogate &&
                             code != 0xFFFE && code != 0xFFFF;
    return isCharacter ? length : 0;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = characterLength(std::string_view(text).substr(i));
        const char c = text[i];
        if (length != 1) {
            result += length == 0 ? "_" : text.substr(i, length);
        } else if (c == '&') {
            result += "&amp;";
        } else if (c == '<') {
            result += "&lt;";
        } else if (c == '"') {
            result += "&quot;";
        } else {
            result += c;
        }
        i += std::max<std::size_t>(length, 1);
    }
    return result;
}

void appendPathData(std::string& text, const std::vector<std::array<double, 2>>& points) {
    const auto put = [&](const std::array<double, 2>& p) {
        text += plainNumber(p[0]) + ",";
        text += plainNumber(p[1]);
    };
    text += 'M';
    put(points[0]);
    for (std::size_t i = 1; i + 2 < points.size(); i += 3) {
        text += " C";
        for (std::size_t k = 0; k < 3; ++k) {
            if (k > 0) text += ' ';
            put(points[i + k]);
        }
    }
}

void appendSvgPath(std::string& text, const OutlinePath& path, const std::string& id) {
    text += "      <path id=\"" + id;
    text += "\" d=\"";
    appendPathData(text, path.points);
    text += path.closed ? " Z\"/>\n" : "\"/>\n";
}

std::string svgHeader(const Outline& outline, const StrokeOptions& options) {
    const std::string width = plainNumber(outline.width), height = plainNumber(outline.height);
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    text += "<svg xmlns=\"http://www.w3.org/2000/svg\" ";
    text += "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" + width;
    text += "mm\" height=\"" + height;
    text += "mm\" viewBox=\"0 0 " + width;
    text += " " + height;
    text += "\">\n  <style>\n";
    text += "    path { stroke-linecap: round; stroke-linejoin: round; }\n";
    text += "    .visible path, .hidden path { fill: none; }\n";
    if (!outline.fills.empty()) {
        text += "    .fill path { fill-rule: evenodd; stroke-width: " + plainNumber(kFillSeam);
        text += "; }\n";
    }
    text += "    .visible path { stroke: " + escaped(options.color);
    text += "; stroke-width: " + plainNumber(options.width);
    text += "; }\n    .hidden path { stroke: " + escaped(options.hiddenColor);
    text += "; stroke-width: " + plainNumber(options.hiddenWidth);
    text += "; stroke-dasharray: " + escaped(options.dash);
    text += "; }\n  </style>\n";
    return text;
}

// All fills lie under all lines.
void appendSvgFills(std::string& text, const Outline& outline, const StrokeOptions& options) {
    const std::vector<FillLayer> layers = fillLayers(outline, options);
    if (layers.empty()) return;
    text += "  <g id=\"fills\" inkscape:groupmode=\"layer\" inkscape:label=\"fills\">\n";
    for (const FillLayer& layer : layers) {
        std::string id = "fill-";
        id += std::to_string(layer.object + 1);
        text += "    <g id=\"" + id;
        text += "\" class=\"fill\" inkscape:groupmode=\"layer\" inkscape:label=\"";
        text += escaped(objectName(outline, layer.object));
        text += "\">\n";
        for (std::size_t k = 0; k < layer.fills.size(); ++k) {
            const OutlineFill& fill = *layer.fills[k];
            const std::string color = hexColor(layer.colors[static_cast<std::size_t>(fill.tone)]);
            text += "      <path id=\"" + id;
            text += '-';
            text += std::to_string(k + 1);
            text += "\" class=\"tone-";
            text += std::to_string(fill.tone);
            text += "\" fill=\"" + color;
            text += "\" stroke=\"" + color;
            text += "\" d=\"";
            for (const auto& loop : fill.loops) {
                appendPathData(text, loop);
                text += 'Z';
            }
            text += "\"/>\n";
        }
        text += "    </g>\n";
    }
    text += "  </g>\n";
}

void appendSvgLayer(std::string& text, const PaintLayer& layer) {
    const std::string sight = layer.sightName(), kind = layer.kindName();
    std::string id = sight;
    id += "-" + kind;
    id += "-" + std::to_string(layer.object + 1);
    text += "    <g id=\"" + id;
    text += "\" class=\"" + sight;
    text += " " + kind;
    text += "\" inkscape:groupmode=\"layer\" inkscape:label=\"" + sight;
    text += " " + kind;
    text += "\">\n";
    for (std::size_t k = 0; k < layer.paths.size(); ++k) {
        std::string pathId = id;
        pathId += "-" + std::to_string(k + 1);
        appendSvgPath(text, *layer.paths[k], pathId);
    }
    text += "    </g>\n";
}

}  // namespace

void writeSvg(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    requireValid(options);
    std::string text = svgHeader(outline, options);
    appendSvgFills(text, outline, options);
    int object = -1;
    for (const PaintLayer& layer : paintLayers(outline)) {
        if (layer.object != object) {
            if (object >= 0) text += "  </g>\n";
            object = layer.object;
            text += "  <g id=\"object-" + std::to_string(object + 1);
            text += "\" inkscape:groupmode=\"layer\" inkscape:label=\"";
            text += escaped(objectName(outline, layer.object));
            text += "\">\n";
        }
        appendSvgLayer(text, layer);
    }
    if (object >= 0) text += "  </g>\n";
    text += "</svg>\n";
    writeWhole(file, text);
}

}  // namespace bandvox
