#include "source/file_integrity.h"

// Keeps Boost from remarking on its own use of its placeholders.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <sstream>

namespace bandvox {
namespace {

using boost::property_tree::ptree;

// Numbers that the glTF specification gives to kinds of primitives.
constexpr int kTriangles = 4;
constexpr int kTriangleStrip = 5;
constexpr int kTriangleFan = 6;

/// The description in JSON: the first chunk of a binary file, or all of a text.
std::string jsonOf(const FileContents& file) {
    constexpr std::size_t kHeaders = 20;
    if (!file.bytes.starts_with("glTF") || file.bytes.size() < kHeaders) return file.bytes;
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        length |= std::size_t(static_cast<unsigned char>(file.bytes[12 + i])) << (8 * i);
    }
    return file.bytes.substr(kHeaders, length);
}

const ptree& child(const ptree& tree, const char* name) {
    static const ptree none;
    const auto found = tree.get_child_optional(name);
    return found ? *found : none;
}

}  // namespace

std::size_t countGltfTriangles(const FileContents& file) {
    ptree tree;
    try {
        std::istringstream text(jsonOf(file));
        boost::property_tree::read_json(text, tree);
    } catch (const boost::property_tree::json_parser_error&) {
        return 0;
    }
    // Version 1 is laid out in another way.
    if (!tree.get("asset.version", std::string()).starts_with("2")) return 0;

    std::vector<std::size_t> counts;
    for (const auto& [name, accessor] : child(tree, "accessors")) {
        counts.push_back(accessor.get("count", std::size_t(0)));
    }
    std::size_t triangles = 0;
    for (const auto& [meshName, mesh] : child(tree, "meshes")) {
        for (const auto& [name, primitive] : child(mesh, "primitives")) {
            const std::size_t position = primitive.get("attributes.POSITION", counts.size());
            const std::size_t accessor = primitive.get("indices", position);
            if (accessor >= counts.size()) continue;
            const std::size_t corners = counts[accessor];
            const int mode = primitive.get("mode", kTriangles);
            if (mode == kTriangles) triangles += corners / 3;
            if ((mode == kTriangleStrip || mode == kTriangleFan) && corners > 2) {
                triangles += corners - 2;
            }
        }
    }
    return triangles;
}

}  // namespace bandvox
