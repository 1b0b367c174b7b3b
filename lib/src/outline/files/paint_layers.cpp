#include "outline/files/paint_layers.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

namespace bandvox {
namespace {

constexpr double kLeastLength = 1e-4;  // what plainNumber does not round to 0

}  // namespace

std::string PaintLayer::kindName() const {
    constexpr std::array kNames{"contour",      "boundary", "crease",
                                "intersection", "isophote", "suggestive"};
    return kNames[static_cast<std::size_t>(kind)];
}

void requireValid(const StrokeOptions& options) {
    for (const double width : {options.width, options.hiddenWidth}) {
        if (width >= kLeastLength && std::isfinite(width)) continue;
        throw Error(ErrorKind::Usage, "a line's width is " + std::to_string(width) +
                                          "; expected one of 0.0001 or more");
    }
    parsedDash(options.dash);
    if (!(options.shade >= 0 && options.shade <= 1)) {
        throw Error(ErrorKind::Usage, "the shade of the darkest tone is " +
                                          std::to_string(options.shade) + "; expected 0 to 1");
    }
    if (options.fillColors.empty()) {
        throw Error(ErrorKind::Usage, "there are no colours to fill with; expected one at least");
    }
    for (const std::string& color : options.fillColors) parsedColor(color);
}

void requireHexColors(const StrokeOptions& options) {
    for (const std::string& color : {options.color, options.hiddenColor}) parsedColor(color);
}

std::string objectName(const Outline& outline, int object) {
    const auto index = static_cast<std::size_t>(object);
    if (index < outline.objects.size()) return outline.objects[index];
    return "object " + std::to_string(object + 1);
}

std::vector<PaintLayer> paintLayers(const Outline& outline) {
    using Key = std::array<int, 3>;  // object, visible, kind
    std::map<Key, std::vector<const OutlinePath*>> sorted;
    for (const OutlinePath& path : outline.paths) {
        const Key key{path.object, path.hidden == 0 ? 1 : 0, static_cast<int>(path.kind)};
        sorted[key].push_back(&path);
    }
    std::vector<PaintLayer> layers;
    layers.reserve(sorted.size());
    for (auto& [key, paths] : sorted) {
        layers.push_back({key[0], key[1] == 1, static_cast<OutlineKind>(key[2]), std::move(paths)});
    }
    return layers;
}

std::vector<FillLayer> fillLayers(const Outline& outline, const StrokeOptions& options) {
    std::map<int, FillLayer> sorted;
    for (const OutlineFill& fill : outline.fills) {
        FillLayer& layer = sorted[fill.object];
        layer.object = fill.object;
        layer.fills.push_back(&fill);
    }
    std::vector<FillLayer> layers;
    layers.reserve(sorted.size());
    for (auto& [object, layer] : sorted) {
        const auto index = static_cast<std::size_t>(object) % options.fillColors.size();
        const auto color = parsedColor(options.fillColors[index]);
        for (int tone = 0; tone < outline.tones; ++tone) {
            const double step = outline.tones > 1 ? double(tone) / (outline.tones - 1) : 1;
            const double light = options.shade + (1 - options.shade) * step;
            layer.colors.push_back({light * color[0], light * color[1], light * color[2]});
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

std::string hexColor(const std::array<double, 3>& color) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text = "#";
    for (const double c : color) {
        const auto value = static_cast<std::size_t>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
        text += kDigits[value / 16];
        text += kDigits[value % 16];
    }
    return text;
}

std::string plainNumber(double value) {
    std::array<char, 400> digits{};
    constexpr int kDecimals = 4;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::fixed, kDecimals)
                         .ptr;
    std::string text(digits.data(), end);
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? "0" : text;
}

std::array<double, 3> parsedColor(const std::string& color) {
    const std::size_t digits = color.size() == 4 ? 1 : 2;
    std::array<double, 3> result{};
    bool isColor = (color.size() == 4 || color.size() == 7) && color.starts_with('#');
    for (std::size_t c = 0; isColor && c < 3; ++c) {
        const char* const begin = color.data() + 1 + c * digits;
        int value = 0;
        const auto read = std::from_chars(begin, begin + digits, value, 16);
        isColor = read.ec == std::errc() && read.ptr == begin + digits && value >= 0;
        result[c] = value / (digits == 1 ? 15.0 : 255.0);
    }
    if (isColor) return result;
    throw Error(ErrorKind::Usage,
                "the colour is \"" + color + "\"; expected one as #000000 or #000");
}

std::vector<double> parsedDash(const std::string& dash) {
    std::vector<double> lengths;
    const char* at = dash.data();
    const char* const end = at + dash.size();
    bool isDash = true;
    while (isDash && at != end) {
        if (*at == ' ' || *at == ',') {
            ++at;
            continue;
        }
        double length = 0;
        const auto read = std::from_chars(at, end, length);
        isDash = read.ec == std::errc() && length >= 0 && std::isfinite(length);
        at = read.ptr;
        lengths.push_back(length);
    }
    const bool isSome =
        std::any_of(lengths.begin(), lengths.end(), [](double l) { return l >= kLeastLength; });
    if (isDash && isSome) return lengths;
    throw Error(ErrorKind::Usage, "the dash is \"" + dash + "\"; expected lengths as \"1.2 0.8\"");
}

void writeWhole(AtomicFile& file, const std::string& text) {
    std::ofstream stream = file.open();
    errno = 0;
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.flush();
    if (stream) return;
    throw Error(ErrorKind::Runtime, "cannot write " + file.target().string() + ": " +
                                        (errno != 0 ? std::strerror(errno) : "unknown failure"));
}

}  // namespace bandvox
