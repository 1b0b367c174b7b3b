#include "source/file_integrity.h"
#include "source/nesting_depth.h"
#include "source/xml_tags.h"

// Keeps Boost from remarking on its own use of its placeholders.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
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

/// Checks lists of whole numbers, of which the importer reads on and on where something else is,
/// and the numbers that say where the values of an array are, which it trusts.
class NumberCheck {
  public:
    explicit NumberCheck(const FileContents& file) : mFile(file) {}

    void check() {
        forEachXmlTag(mFile.bytes, [this](const XmlTag& tag) { visit(tag); });
        for (const Accessor& accessor : mAccessors) {
            const auto found = mArrays.find(accessor.array);
            if (found != mArrays.end() && found->second < accessor.end) {
                mFile.fail("has an accessor of values up to " + std::to_string(accessor.end) +
                           " of the array \"" + std::string(accessor.array.substr(0, 40)) +
                           "\"; expected at most the " + std::to_string(found->second) +
                           " that it has");
            }
        }
    }

  private:
    struct Accessor {
        std::string_view array;
        std::uint64_t end;
    };

    void visit(const XmlTag& tag) {
        if (tag.kind == XmlTag::Kind::Close) return;
        constexpr std::array<std::string_view, 13> kCounted = {
            "float_array", "Name_array", "IDREF_array",   "accessor", "input",
            "triangles",   "polylist",   "polygons",      "trifans",  "tristrips",
            "lines",       "linestrips", "vertex_weights"};
        const bool isCounted =
            std::find(kCounted.begin(), kCounted.end(), tag.name) != kCounted.end();
        const std::uint64_t count = isCounted ? numberOf(tag, "count", 0) : 0;
        if (tag.name == "float_array") mArrays[tag.attribute("id").value_or("")] = count;
        if (tag.name == "accessor") {
            const std::string_view source = tag.attribute("source").value_or("");
            // No product is too large, as none of them is larger than a file.
            const std::uint64_t stride = numberOf(tag, "stride", 1);
            const std::uint64_t end = numberOf(tag, "offset", 0) + count * stride;
            mAccessors.push_back({source.substr(source.starts_with('#') ? 1 : 0), end});
        } else if (isCounted) {
            numberOf(tag, "offset", 0);
        }
        const bool isList = tag.name == "p" || tag.name == "v" || tag.name == "vcount";
        if (isList && tag.kind == XmlTag::Kind::Open) checkList(tag);
    }

    /// An attribute as a whole number, which is no more than the bytes of the file: honest ones
    /// count what is in it.
    std::uint64_t numberOf(const XmlTag& tag, std::string_view name, std::uint64_t standard) const {
        const auto text = tag.attribute(name);
        if (!text) return standard;
        std::uint64_t number = 0;
        const auto [end, error] =
            std::from_chars(text->data(), text->data() + text->size(), number);
        const bool isWhole = error == std::errc() && end == text->data() + text->size();
        if (isWhole && number <= mFile.bytes.size()) return number;
        std::string what = "has an element \"";
        what += tag.name.substr(0, 40);
        what += "\" whose ";
        what += name;
        what += " is \"";
        what += text->substr(0, 40);
        what += "\"; expected a whole number, at most that of the file's bytes";
        mFile.fail(what);
    }

    void checkList(const XmlTag& tag) const {
        const std::string_view bytes = mFile.bytes;
        const std::size_t end = bytes.find_first_not_of("0123456789+- \t\r\n", tag.end);
        if (end == std::string_view::npos || bytes.substr(end).starts_with("</")) return;
        std::string what = "has \"";
        what += bytes.substr(end, std::min<std::size_t>(bytes.find('<', end) - end, 20));
        what += "\" in a list \"";
        what += tag.name;
        what += "\"; expected whole numbers";
        mFile.fail(what);
    }

    const FileContents& mFile;
    std::map<std::string_view, std::uint64_t> mArrays;  // how many values each has
    std::vector<Accessor> mAccessors;
};

}  // namespace

void checkCollada(const FileContents& file) {
    requireShallow(file, xmlDepth(file.bytes));
    NumberCheck(file).check();
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
