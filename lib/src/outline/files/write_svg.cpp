#include "outline/files/paint_layers.h"

#include <cstddef>

namespace bandvox {
namespace {

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '&') {
            result += "&amp;";
        } else if (c == '<') {
            result += "&lt;";
        } else if (c == '"') {
            result += "&quot;";
        } else {
            result += code < 0x20 ? '_' : c;
        }
    }
    return result;
}

void appendSvgPath(std::string& text, const OutlinePath& path, const std::string& id) {
    text += "      <path id=\"" + id;
    text += "\" d=\"";
    const auto put = [&](const std::array<double, 2>& p) {
        text += plainNumber(p[0]) + ",";
        text += plainNumber(p[1]);
    };
    text += 'M';
    put(path.points[0]);
    for (std::size_t i = 1; i + 2 < path.points.size(); i += 3) {
        text += " C";
        for (std::size_t k = 0; k < 3; ++k) {
            if (k > 0) text += ' ';
            put(path.points[i + k]);
        }
    }
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
    text += "    path { fill: none; stroke-linecap: round; stroke-linejoin: round; }\n";
    text += "    .visible path { stroke: " + escaped(options.color);
    text += "; stroke-width: " + plainNumber(options.width);
    text += "; }\n    .hidden path { stroke: " + escaped(options.hiddenColor);
    text += "; stroke-width: " + plainNumber(options.hiddenWidth);
    text += "; stroke-dasharray: " + escaped(options.dash);
    text += "; }\n  </style>\n";
    return text;
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
    std::string text = svgHeader(outline, options);
    int object = -1;
    for (const PaintLayer& layer : paintLayers(outline)) {
        if (layer.object != object) {
            if (object >= 0) text += "  </g>\n";
            object = layer.object;
            text += "  <g id=\"object-" + std::to_string(object + 1);
            text += "\" inkscape:groupmode=\"layer\" inkscape:label=\"";
            text += escaped(layer.objectName(outline));
            text += "\">\n";
        }
        appendSvgLayer(text, layer);
    }
    if (object >= 0) text += "  </g>\n";
    text += "</svg>\n";
    writeWhole(file, text);
}

}  // namespace bandvox
