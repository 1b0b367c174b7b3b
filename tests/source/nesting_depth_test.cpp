// Files that are nested so deep that parsers run out of their stack.

#include "source/nesting_depth.h"

#include "source/mesh_files.h"
#include "source/test_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/source/read_mesh.h>

#include <gtest/gtest.h>

#include <string>

namespace bandvox {
namespace {

using test::bytesOf;
using test::TemporaryFolder;

constexpr std::size_t kMany = 100000;

std::string repeated(const std::string& text, std::size_t times) {
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

/// Records of a binary FBX file, each but the last with one more inside.
std::string fbxRecords(std::size_t count, bool wide) {
    const std::size_t width = wide ? 8 : 4;
    const std::size_t empty = 3 * width + 1;
    const std::size_t record = empty + 1;
    std::string bytes = std::string("Kaydara FBX Binary  \0\x1a\0", 23) +
                        bytesOf(std::uint32_t(wide ? 7500 : 7400));
    const std::size_t end = bytes.size() + record * count + empty * (count - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string number = bytesOf(std::uint64_t(end - empty * i)).substr(0, width);
        bytes += number + std::string(2 * width, '\0') + "\1A";
    }
    return bytes + std::string(empty * (count - 1), '\0') + std::string(2 * empty, '\0');
}

/// A glTF file whose nodes are a chain of this many.
std::string chainOfNodes(std::size_t count) {
    std::string nodes;
    for (std::size_t i = 1; i < count; ++i) {
        nodes += R"({"children":[)" + std::to_string(i) + "]},";
    }
    return test::embeddedGltf(test::cube(openvdb::Vec3d(0.0), 1.0), nodes + R"({"mesh":0})", 1);
}

std::string collada(const std::string& nodes) {
    return "<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\"><asset/><library_visual_scenes>"
           "<visual_scene id=\"s\">" +
           nodes +
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/>"
           "</scene></COLLADA>\n";
}

std::string messageOf(const std::filesystem::path& path) {
    try {
        readMesh(path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        return error.what();
    }
    return "";
}

TEST(NestingDepth, OfJson) {
    EXPECT_EQ(jsonDepth(""), 0u);
    EXPECT_EQ(jsonDepth("1"), 0u);
    EXPECT_EQ(jsonDepth(R"({"a":[1,[2]],"b":{}})"), 3u);
    EXPECT_EQ(jsonDepth(R"({"a[[[":"\"[[[\\"})"), 1u);
    EXPECT_EQ(jsonDepth(R"({"a":"\\","b":[[1]]})"), 3u);
    EXPECT_EQ(jsonDepth("]]][[\""), 2u);
    EXPECT_EQ(jsonDepth("\"\\"), 0u);
    EXPECT_EQ(jsonDepth(repeated("[", kMany)), kMany);
}

TEST(NestingDepth, OfXml) {
    EXPECT_EQ(xmlDepth(""), 0u);
    EXPECT_EQ(xmlDepth("no elements"), 0u);
    EXPECT_EQ(xmlDepth("<?xml version='1.0'?><a><b/><c>text</c></a>"), 2u);
    EXPECT_EQ(xmlDepth("<a x='>' y=\"/>\"><b></b></a>"), 2u);
    EXPECT_EQ(xmlDepth("<a><!-- <b><b><b> --><![CDATA[<c><c>]]></a>"), 1u);
    EXPECT_EQ(xmlDepth("<a><!-- ' --><b><c/></b></a>"), 2u);
    EXPECT_EQ(xmlDepth("<!DOCTYPE a [<!ELEMENT a (b)>]><a><b/></a>"), 1u);
    EXPECT_EQ(xmlDepth("<!DOCTYPE a><a><b></b></a>"), 2u);
    EXPECT_EQ(xmlDepth("</a></a><a><a>"), 2u);
    EXPECT_EQ(xmlDepth("<"), 1u);
    EXPECT_EQ(xmlDepth("<!--"), 0u);
    EXPECT_EQ(xmlDepth(repeated("<a>", kMany)), kMany);
}

TEST(NestingDepth, OfFbx) {
    EXPECT_EQ(fbxDepth(""), 0u);
    EXPECT_EQ(fbxDepth("; FBX {{{\nA: {\n B: \"{{{\", 1 {\n }\n}\n"), 2u);
    EXPECT_EQ(fbxDepth("A: \"}}\" { ; }}\n{"), 2u);
    EXPECT_EQ(fbxDepth(std::string("{\0{{", 4)), 1u);
    EXPECT_EQ(fbxDepth(repeated("A: {", kMany)), kMany);
    for (const bool wide : {false, true}) {
        EXPECT_EQ(fbxDepth(fbxRecords(1, wide)), 1u);
        EXPECT_EQ(fbxDepth(fbxRecords(7, wide)), 7u);
        EXPECT_EQ(fbxDepth(fbxRecords(kMany, wide)), kMany);
        for (std::size_t cut = 0; cut < 100; ++cut) {
            EXPECT_LE(fbxDepth(fbxRecords(7, wide).substr(0, cut)), 7u);
        }
    }
}

TEST(NestingDepth, FilesThatAreTooDeepAreRefused) {
    const TemporaryFolder folder;
    const std::string deepJson =
        R"({"asset":{"version":"2.0"},"x":)" + repeated("[", kMany) + repeated("]", kMany) + "}";
    const auto size32 = [](std::size_t size) { return bytesOf(static_cast<std::uint32_t>(size)); };
    const std::string nodes = repeated("<node>", kMany) + repeated("</node>", kMany);
    const std::pair<const char*, std::string> files[] = {
        {"a.gltf", deepJson},
        {"chain.gltf", chainOfNodes(kMany)},
        {"a.glb", "glTF" + size32(2) + size32(20 + deepJson.size()) + size32(deepJson.size()) +
                      "JSON" + deepJson},
        {"a.dae", collada(nodes)},
        {"text.fbx", "; FBX 7.3.0 project file\n" + repeated("A: {", kMany)},
        {"narrow.fbx", fbxRecords(kMany, false)},
        {"wide.fbx", fbxRecords(kMany, true)}};
    for (const auto& [name, bytes] : files) {
        const std::string message = messageOf(folder.write(name, bytes));
        EXPECT_NE(message.find("is nested 100"), std::string::npos) << name << ": " << message;
        EXPECT_NE(message.find("at most 500 is read"), std::string::npos) << name;
    }
    // The importer would look for the sign of another format.
    for (const std::string& text : {collada(nodes), "{" + collada(nodes)}) {
        EXPECT_NE(messageOf(folder.write("b.gltf", text)).find("JSON"), std::string::npos);
    }
    EXPECT_NE(messageOf(folder.write("c.gltf", R"({"asset":{"version":"3.0"},"x":"<collada"})"))
                  .find("\"3.0\""),
              std::string::npos);
}

TEST(NestingDepth, FilesThatAreDeepEnoughAreRead) {
    const TemporaryFolder folder;
    EXPECT_EQ(messageOf(folder.write("chain.gltf", chainOfNodes(kDeepestNesting))), "");
    EXPECT_NE(messageOf(folder.write("longer.gltf", chainOfNodes(kDeepestNesting + 1))), "");
    const std::size_t levels = kDeepestNesting - 3;
    const std::string nodes = repeated("<node>", levels) + repeated("</node>", levels);
    EXPECT_EQ(messageOf(folder.write("a.dae", collada(nodes))).find("nested"), std::string::npos);
    EXPECT_EQ(messageOf(folder.write("a.fbx", fbxRecords(kDeepestNesting, true))).find("nested"),
              std::string::npos);
}

// Nodes of a library that refer to each other: `last` is what the last one holds.
std::string colladaOfReferences(int count, const std::string& last, bool twice = true) {
    std::string nodes;
    for (int i = 0; i < count; ++i) {
        const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
        nodes +=
            "<node id=\"n" + std::to_string(i) + "\">" + next + (twice ? next : "") + "</node>";
    }
    nodes += "<node id=\"n" + std::to_string(count) + "\">" + last + "</node>";
    return collada(nodes);
}

TEST(NestingDepth, ReferencesWithoutEndAreRefused) {
    const TemporaryFolder folder;
    const std::string itself = messageOf(
        folder.write("a.dae", colladaOfReferences(3, "<node><instance_node url=\"#n1\"/></node>")));
    EXPECT_NE(itself.find("an instance of itself"), std::string::npos) << itself;
    const std::string many = messageOf(folder.write("b.dae", colladaOfReferences(60, "")));
    EXPECT_NE(many.find("more than a million nodes"), std::string::npos) << many;
    const std::string deep = messageOf(folder.write("d.dae", colladaOfReferences(1000, "", false)));
    EXPECT_NE(deep.find("is nested 501"), std::string::npos) << deep;
    const std::string few = messageOf(folder.write("c.dae", colladaOfReferences(5, "")));
    EXPECT_EQ(few.find("node"), std::string::npos) << few;
}

// Each node holds the next one twice: 2^n ways lead to the last.
TEST(NestingDepth, NodesUnderTwoAreRefused) {
    const TemporaryFolder folder;
    const auto path =
        folder.write("a.gltf", test::embeddedGltf(test::cube(openvdb::Vec3d(0.0), 1.0),
                                                  R"({"children":[1,1]},{"children":[2,2]},)"
                                                  R"({"mesh":0})",
                                                  1));
    EXPECT_NE(messageOf(path).find("has a node 1 that is a child twice"), std::string::npos)
        << messageOf(path);
}

TEST(NestingDepth, NodesUnderThemselvesAreRefused) {
    const TemporaryFolder folder;
    const auto path =
        folder.write("a.gltf", test::embeddedGltf(test::cube(openvdb::Vec3d(0.0), 1.0),
                                                  R"({"children":[1],"mesh":0},{"children":[2]},)"
                                                  R"({"children":[0]})",
                                                  1));
    EXPECT_NE(messageOf(path).find("recursive"), std::string::npos) << messageOf(path);
}

}  // namespace
}  // namespace bandvox
