#include "source/file_integrity.h"
#include "source/little_endian.h"
#include "source/nesting_depth.h"

// Keeps Boost from remarking on its own use of its placeholders.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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
    return file.bytes.substr(kHeaders, littleEndian32(file.bytes, 12));
}

const ptree& child(const ptree& tree, const char* name) {
    static const ptree none;
    const auto found = tree.get_child_optional(name);
    return found ? *found : none;
}

/// Complains about a node that is the child of two. The specification forbids it, and the importer
/// would copy what is below such nodes once for each way that leads there.
void requireTrees(const FileContents& file, const std::vector<std::vector<std::string>>& children) {
    std::set<std::string> seen;
    for (const auto& names : children) {
        for (const std::string& name : names) {
            if (seen.insert(name).second) continue;
            file.fail("has a node " + name.substr(0, 40) +
                      " that is a child twice; expected each once at most");
        }
    }
}

/// How deep the nodes are under each other. The importer follows their children by calling itself.
std::size_t nodeDepth(const FileContents& file, const ptree& tree) {
    // Version 1 names the nodes, version 2 counts them.
    std::map<std::string, std::size_t> numbers;
    std::vector<std::vector<std::string>> children;
    for (const auto& [name, node] : child(tree, "nodes")) {
        numbers.emplace(name.empty() ? std::to_string(children.size()) : name, children.size());
        auto& names = children.emplace_back();
        for (const auto& [none, value] : child(node, "children")) names.push_back(value.data());
    }
    requireTrees(file, children);

    // Depth of the nodes below each, itself included; 0 if it is not known yet. A node that is its
    // own descendant ends its path here, and the importer refuses it.
    std::vector<std::size_t> depths(children.size(), 0);
    std::vector<bool> open(children.size(), false);
    std::size_t deepest = 0;
    for (std::size_t root = 0; root < children.size(); ++root) {
        std::vector<std::pair<std::size_t, std::size_t>> path;  // node, and its next child
        const auto enter = [&](std::size_t node) {
            open[node] = true;
            path.emplace_back(node, 0);
        };
        if (depths[root] == 0) enter(root);
        while (!path.empty()) {
            auto& [node, next] = path.back();
            if (next < children[node].size()) {
                const auto found = numbers.find(children[node][next++]);
                if (found == numbers.end()) continue;
                const std::size_t below = found->second;
                if (depths[below] == 0 && !open[below]) enter(below);
                continue;
            }
            for (const std::string& name : children[node]) {
                const auto found = numbers.find(name);
                if (found != numbers.end()) {
                    depths[node] = std::max(depths[node], depths[found->second]);
                }
            }
            deepest = std::max(deepest, ++depths[node]);
            open[node] = false;
            path.pop_back();
        }
    }
    return deepest;
}

std::size_t countTriangles(const ptree& tree) {
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

}  // namespace

std::size_t checkGltf(const FileContents& file) {
    const std::string json = jsonOf(file);
    requireShallow(file, jsonDepth(json));
    ptree tree;
    try {
        std::istringstream text(json);
        boost::property_tree::read_json(text, tree);
    } catch (const boost::property_tree::json_parser_error& error) {
        file.fail("is malformed: line " + std::to_string(error.line()) +
                  " of its JSON: " + error.message());
    }
    // What is no glTF the importer takes for any other format that it finds a sign of.
    const std::string version = tree.get("asset.version", std::string());
    if (!version.starts_with("1") && !version.starts_with("2")) {
        file.fail("is of version \"" + version.substr(0, 40) + "\" of glTF; expected 1 or 2");
    }
    requireShallow(file, nodeDepth(file, tree));
    // Version 1 is laid out in another way.
    return version.starts_with("2") ? countTriangles(tree) : 0;
}

}  // namespace bandvox
