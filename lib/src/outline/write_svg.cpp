#include <bandvox/core/error.h>
#include <bandvox/outline/write_outline.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace bandvox {
namespace {

constexpr std::array<const char*, 4> kKindNames{"contour", "boundary", "crease", "intersection"};

// A coordinate to a tenth of a micrometre, without needless zeros.
std::string svgNumber(double value) {
    std::array<char, 64> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::fixed, 4)
                         .ptr;
    std::string text(digits.data(), end);
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? "0" : text;
}

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

void appendPath(std::string& text, const OutlinePath& path, const std::string& id) {
    text += "      <path id=\"" + id;
    text += "\" d=\"";
    const auto put = [&](const std::array<double, 2>& p) {
        text += svgNumber(p[0]) + ",";
        text += svgNumber(p[1]);
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

std::string header(const Outline& outline, const StrokeOptions& options) {
    const std::string width = svgNumber(outline.width), height = svgNumber(outline.height);
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    text += "<svg xmlns=\"http://www.w3.org/2000/svg\" ";
    text += "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" + width;
    text += "mm\" height=\"" + height;
    text += "mm\" viewBox=\"0 0 " + width + " ";
    text += height + "\">\n  <style>\n";
    text += "    path { fill: none; stroke-linecap: round; stroke-linejoin: round; }\n";
    text += "    .visible path { stroke: " + escaped(options.color);
    text += "; stroke-width: " + svgNumber(options.width) + "; }\n";
    text += "    .hidden path { stroke: " + escaped(options.hiddenColor);
    text += "; stroke-width: " + svgNumber(options.hiddenWidth);
    text += "; stroke-dasharray: " + escaped(options.dash) + "; }\n  </style>\n";
    return text;
}

}  // namespace

void writeSvg(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    // Hidden lines first, so that visible ones lie above them.
    using Layer = std::array<int, 3>;  // object, visible, kind
    std::map<Layer, std::vector<const OutlinePath*>> layers;
    for (const OutlinePath& path : outline.paths) {
        layers[{path.object, path.hidden == 0 ? 1 : 0, static_cast<int>(path.kind)}].push_back(
            &path);
    }
    std::string text = header(outline, options);
    int object = -1;
    for (const auto& [layer, paths] : layers) {
        const std::string number = std::to_string(layer[0] + 1);
        if (layer[0] != object) {
            if (object >= 0) text += "  </g>\n";
            object = layer[0];
            const auto index = static_cast<std::size_t>(object);
            const std::string name =
                index < outline.objects.size() ? outline.objects[index] : "object " + number;
            text += "  <g id=\"object-" + number;
            text += "\" inkscape:groupmode=\"layer\" inkscape:label=\"" + escaped(name) + "\">\n";
        }
        const std::string sight = layer[1] == 1 ? "visible" : "hidden";
        const std::string kind = kKindNames[static_cast<std::size_t>(layer[2])];
        std::string id = sight + "-";
        id += kind + "-";
        id += number;
        text += "    <g id=\"" + id;
        text += "\" class=\"" + sight + " ";
        text += kind + "\" inkscape:groupmode=\"layer\" inkscape:label=\"";
        text += sight + " ";
        text += kind + "\">\n";
        for (std::size_t k = 0; k < paths.size(); ++k) {
            std::string pathId = id + "-";
            pathId += std::to_string(k + 1);
            appendPath(text, *paths[k], pathId);
        }
        text += "    </g>\n";
    }
    if (object >= 0) text += "  </g>\n";
    text += "</svg>\n";
    std::ofstream stream = file.open();
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.flush();
    if (stream) return;
    throw Error(ErrorKind::Runtime, "\"" + file.target().string() + "\" could not be written");
}

}  // namespace bandvox
