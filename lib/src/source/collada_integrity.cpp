#include "source/file_integrity.h"
#include "source/nesting_depth.h"

// Keeps Boost from remarking on its own use of its placeholders.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

using boost::property_tree::ptree;

/// Nodes of a scene that a file may come to; honest ones have some thousands.
constexpr double kMostNodes = 1e6;

/// The nodes of a scene, each with those below it: its own, and what it refers to.
class NodeGraph {
  public:
    /// Adds what is below an element; `node` is the node that it belongs to.
    void add(const ptree& element, std::size_t node) {
        for (const auto& [name, child] : element) {
            if (name == "node") {
                const std::size_t below = mBelow.size();
                mBelow[node].push_back(below);
                mBelow.emplace_back();
                mReferences.emplace_back();
                const auto id = child.get_optional<std::string>("<xmlattr>.id");
                if (id) mNumbers.emplace(*id, below);
                add(child, below);
            } else if (name == "instance_node") {
                const std::string url = child.get("<xmlattr>.url", std::string());
                if (url.starts_with('#')) mReferences[node].push_back(url.substr(1));
            } else {
                add(child, node);
            }
        }
    }

    void resolve() {
        for (std::size_t i = 0; i < mBelow.size(); ++i) {
            for (const std::string& id : mReferences[i]) {
                const auto found = mNumbers.find(id);
                if (found != mNumbers.end()) mBelow[i].push_back(found->second);
            }
        }
    }

    /// How many nodes node i comes to when all references are followed; infinite if it leads back
    /// to itself.
    double countFrom(std::size_t i, std::size_t depth = 0) {
        mDepth = std::max(mDepth, depth);
        if (depth > kDeepestNesting) return 1;
        mCount.resize(mBelow.size(), kUnknown);
        if (mCount[i] != kUnknown) return mCount[i];
        mCount[i] = HUGE_VAL;  // met again on the way, it is below itself
        double count = 1;
        for (const std::size_t below : mBelow[i]) count += countFrom(below, depth + 1);
        return mCount[i] = count;
    }

    /// How far down that went, no more than one beyond what is read.
    std::size_t depth() const { return mDepth; }

  private:
    static constexpr double kUnknown = -1;

    std::vector<std::vector<std::size_t>> mBelow = {{}};  // the root is the file itself
    std::vector<std::vector<std::string>> mReferences = {{}};
    std::map<std::string, std::size_t> mNumbers;
    std::vector<double> mCount;
    std::size_t mDepth = 0;
};

}  // namespace

void checkCollada(const FileContents& file) {
    requireShallow(file, xmlDepth(file.bytes));
    // Only references can make a scene larger than its file, and the importer follows them blindly.
    if (file.bytes.find("instance_node") == std::string::npos) return;
    ptree tree;
    try {
        std::istringstream text(file.bytes);
        boost::property_tree::read_xml(text, tree);
    } catch (const boost::property_tree::xml_parser_error& error) {
        file.fail("is malformed: line " + std::to_string(error.line()) +
                  " of its XML: " + error.message());
    }
    NodeGraph graph;
    graph.add(tree, 0);
    graph.resolve();
    const double count = graph.countFrom(0);
    requireShallow(file, graph.depth());
    if (count <= kMostNodes) return;
    file.fail(std::isinf(count) ? "has a node that is an instance of itself"
                                : "comes to more than a million nodes when its references are "
                                  "followed; expected fewer");
}

}  // namespace bandvox
