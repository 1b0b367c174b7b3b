#include "view_page.h"

#include "grid_report.h"
#include "report_words.h"
#include "view_template.h"
#include "words.h"

#include <bandvox/core/error.h>
#include <bandvox/core/version.h>
#include <bandvox/grid/density_grid.h>

#include <nlohmann/json.hpp>
#include <openvdb/math/Half.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace bandvox::app {
namespace {

using Json = nlohmann::ordered_json;

// Where the template holds what a page puts in; each of them once, in this order.
constexpr std::string_view kTitleMark = "@bandvox-title@";
constexpr std::string_view kHeaderMark = "@bandvox-header@";
constexpr std::string_view kTextureMark = "@bandvox-texture@";

// Numbers that JSON has no words for become null.
Json numbersOf(const openvdb::Vec3d& vector) {
    return toJson(vector);
}

// JSON of ASCII alone, bytes that are no UTF-8 replaced, without what begins or ends an element.
std::string safeJson(const Json& json) {
    const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        // These stand in strings alone.
        switch (c) {
            case '<':
                safe += "\\u003c";
                break;
            case '>':
                safe += "\\u003e";
                break;
            case '&':
                safe += "\\u0026";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

// Text between tags, ASCII alone: what is not becomes a reference to its character.
std::string safeText(const std::string& text) {
    const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    const std::string valid = Json::parse(quoted).get<std::string>();
    std::string safe;
    for (const char c : valid) {
        if (c == '<') {
            safe += "&lt;";
        } else if (c == '>') {
            safe += "&gt;";
        } else if (c == '&') {
            safe += "&amp;";
        } else {
            // Control characters have no place in HTML.
            safe += static_cast<unsigned char>(c) < ' ' || c == 0x7F ? ' ' : c;
        }
    }
    return safe;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t b = 0; b < 3; ++b) {
            group = group << 8 | (b < count ? static_cast<unsigned char>(bytes[i + b]) : 0U);
        }
        for (std::size_t d = 0; d < 4; ++d) {
            text += d <= count ? kDigits[group >> (18 - 6 * d) & 63U] : '=';
        }
    }
    return text;
}

// Deflates a piece at a time, so that it can be interrupted.
std::string deflated(std::string_view bytes, const Progress& progress) {
    constexpr int kLevel = 9;
    constexpr std::size_t kPiece = 1 << 20;
    z_stream stream{};
    if (deflateInit(&stream, kLevel) != Z_OK) throw std::bad_alloc();
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
    std::string out;
    std::string buffer(kPiece, '\0');
    int state = Z_OK;
    for (std::size_t at = 0; state != Z_STREAM_END;) {
        progress.throwIfInterrupted();
        const std::size_t count = std::min(kPiece, bytes.size() - at);
        // zlib does not change what it reads, whatever the pointer's type says.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
        stream.avail_in = static_cast<uInt>(count);
        at += count;
        do {
            stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
            stream.avail_out = static_cast<uInt>(buffer.size());
            state = deflate(&stream, at == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
            out.append(buffer, 0, buffer.size() - stream.avail_out);
        } while (stream.avail_out == 0 && state != Z_STREAM_END);
    }
    return out;
}

// The texture's place in the world: that of its middle, and the ways from a sample to the next.
void placeTexture(const ViewPage& page, Json& out) {
    const VolumeTexture& texture = page.texture;
    const openvdb::math::Transform& transform = page.grid->transform();
    openvdb::Vec3d middle = texture.first;
    openvdb::Vec3d half;
    for (int axis = 0; axis < 3; ++axis) {
        half[axis] = 0.5 * (texture.size[axis] - 1) * texture.spacing[axis];
        middle[axis] += half[axis];
    }
    out["center"] = numbersOf(transform.indexToWorld(middle));
    out["steps"] = Json::array();
    for (int axis = 0; axis < 3; ++axis) {
        // From one end to the other: the mean, where a transform is not linear.
        openvdb::Vec3d reach(0.0);
        reach[axis] = std::max(half[axis], 0.5);
        const openvdb::Vec3d whole =
            transform.indexToWorld(middle + reach) - transform.indexToWorld(middle - reach);
        out["steps"].push_back(numbersOf(whole * (texture.spacing[axis] / (2 * reach[axis]))));
    }
    out["linear"] = transform.isLinear();
}

}  // namespace

double viewIso(const openvdb::FloatGrid& grid, const std::optional<double>& asked,
               const VolumeTexture& texture) {
    if (asked) return *asked;
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return 0;
    const auto stored = grid.getMetadata<openvdb::DoubleMetadata>("bandvox_iso");
    const double iso = stored ? stored->value() : 0.5;
    if (texture.low < iso && iso < texture.high) return iso;
    return 0.5 * (static_cast<double>(texture.low) + texture.high);
}

void summarizeGrid(ViewPage& page, const std::optional<double>& asked, int size,
                   Progress& progress) {
    constexpr int kMostBlocks = 200;
    page.texture = gridToTexture(*page.grid, size, progress);
    page.histogram = valueHistogram(*page.grid, progress);
    page.spectrum = radialSpectrum(*page.grid, kMostBlocks, progress);
    page.iso = viewIso(*page.grid, asked, page.texture);
}

std::vector<std::string> doubtsAbout(const ViewPage& page) {
    std::vector<std::string> doubts;
    const VolumeTexture& texture = page.texture;
    if (!(texture.low < page.iso && page.iso < texture.high)) {
        doubts.push_back("no surface is seen: the iso-value is " + formatNumber(page.iso) +
                         ", and the values shown go from " + formatNumber(texture.low) + " to " +
                         formatNumber(texture.high));
    }
    if (texture.notFiniteValues > 0) {
        doubts.push_back(formatCount(texture.notFiniteValues, "value is not finite, and is",
                                     "values are not finite, and are") +
                         " shown as background");
    }
    if (!page.grid->transform().isLinear()) {
        doubts.emplace_back("the grid's transform is not linear; its shape is shown as if it was");
    }
    return doubts;
}

nlohmann::ordered_json viewHeader(const ViewPage& page) {
    const VolumeTexture& texture = page.texture;
    Json header;
    header["version"] = version();
    header["title"] = page.title;
    header["file"] = page.file;
    header["iso"] = page.iso;
    // Whatever is there rises above its background, or falls below it as level sets do.
    header["inside"] = page.grid->background() > page.iso ? "below" : "above";
    header["background"] = page.grid->background();
    Json& place = header["texture"];
    place["size"] = texture.size;
    place["low"] = texture.low;
    place["high"] = texture.high;
    place["spacing"] = numbersOf(texture.spacing);
    place["first"] = numbersOf(texture.first);
    placeTexture(page, place);
    place["not_finite"] = texture.notFiniteValues;
    header["histogram"] = {{"low", page.histogram.low},
                           {"high", page.histogram.high},
                           {"active", page.histogram.active},
                           {"inactive", page.histogram.inactive}};
    header["spectrum"] = {{"block_side", RadialSpectrum::kBlockSide},
                          {"blocks", page.spectrum.blocks},
                          {"power", page.spectrum.power}};
    header["grid"] = gridReport(*page.grid);
    return header;
}

std::string viewTexture(const VolumeTexture& texture, const Progress& progress) {
    const std::size_t count = texture.values.size();
    const double range = static_cast<double>(texture.high) - texture.low;
    const double scale = range > 0 ? 1 / range : 0;
    // Neighbours differ in their low bytes, and hardly in their high ones.
    std::string bytes(2 * count, '\0');
    for (std::size_t i = 0; i < count; ++i) {
        const double part = (static_cast<double>(texture.values[i]) - texture.low) * scale;
        const std::uint16_t bits = openvdb::math::half(static_cast<float>(part)).bits();
        bytes[i] = static_cast<char>(bits & 0xFFU);
        bytes[count + i] = static_cast<char>(bits >> 8);
    }
    return deflated(bytes, progress);
}

std::string viewHtml(const ViewPage& page, const Progress& progress) {
    const std::array<std::pair<std::string_view, std::string>, 3> parts{
        {{kTitleMark, safeText(page.title)},
         {kHeaderMark, safeJson(viewHeader(page))},
         {kTextureMark, base64(viewTexture(page.texture, progress))}}};
    std::string html;
    std::string_view rest = viewTemplate();
    for (const auto& [mark, part] : parts) {
        const std::size_t at = rest.find(mark);
        if (at == std::string_view::npos) {
            throw Error(ErrorKind::Runtime, "the page that is built in has no " +
                                                std::string(mark) +
                                                "; expected it where the template has it");
        }
        html += rest.substr(0, at);
        html += part;
        rest.remove_prefix(at + mark.size());
    }
    html += rest;
    return html;
}

}  // namespace bandvox::app
