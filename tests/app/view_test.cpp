// What the view command writes: a page that holds its data, and nothing that gets out of hand.

#include "build_places.h"
#include "run_command.h"
#include "sample_files.h"

#include <bandvox/grid/density_grid.h>
#include <bandvox/grid/volume_summary.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <openvdb/math/Half.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <zlib.h>

#include <cmath>
#include <limits>

namespace bandvox::app_test {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;

// What stands between two texts, of which the first has to be there once.
std::string between(const std::string& page, const std::string& begin, const std::string& end) {
    const std::size_t at = page.find(begin);
    EXPECT_NE(at, std::string::npos) << begin;
    if (at == std::string::npos) return {};
    EXPECT_EQ(page.find(begin, at + 1), std::string::npos) << begin;
    const std::size_t from = at + begin.size();
    return page.substr(from, page.find(end, from) - from);
}

std::string headerText(const std::string& page) {
    return between(page, "<script type=\"application/json\" id=\"volume-header\">", "</script>");
}

std::string fromBase64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        const std::size_t digit = digits.find(c);
        EXPECT_NE(digit, std::string::npos) << c;
        group = group << 6 | static_cast<std::uint32_t>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(group >> bits & 0xFFU);
    }
    return bytes;
}

// The values that a page shows, from their bytes.
std::vector<double> valuesOf(const std::string& page, const Json& header) {
    const Json& texture = header.at("texture");
    const auto size = texture.at("size").get<std::vector<std::size_t>>();
    const std::size_t count = size[0] * size[1] * size[2];
    const std::string packed = fromBase64(
        between(page, "<script type=\"text/plain\" id=\"volume-texture\">", "</script>"));
    std::string bytes(2 * count + 1, '\0');
    auto length = static_cast<uLongf>(bytes.size());
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data()),
                         static_cast<uLong>(packed.size())),
              Z_OK);
    EXPECT_EQ(length, 2 * count);
    const double low = texture.at("low"), high = texture.at("high");
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        openvdb::math::half part;
        part.setBits(static_cast<std::uint16_t>(
            static_cast<unsigned char>(bytes[i]) |
            static_cast<unsigned>(static_cast<unsigned char>(bytes[count + i])) << 8));
        values.push_back(low + (high - low) * static_cast<float>(part));
    }
    return values;
}

class View : public testing::Test {
  protected:
    RunResult view(Names arguments, const RunOptions& options = {}) {
        arguments.insert(arguments.begin(), "view");
        RunOptions here = options;
        here.folder = mFolder.path();
        return runBandvox(arguments, here);
    }

    void convert(const std::string& name, const Names& more = {}) {
        Names arguments{"convert", "shape:torus", "-o", name, "-r", "32"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const RunResult result = runBandvox(arguments, {.folder = mFolder.path()});
        ASSERT_EQ(result.status, 0) << result.err;
    }

    void write(const std::string& name, const openvdb::GridCPtrVec& grids) {
        writeVdb(mFolder / name, grids);
    }

    TemporaryFolder mFolder;
};

TEST_F(View, WritesAPageThatHoldsTheGrid) {
    convert("t.vdb");
    const RunResult result = view({"t.vdb", "-o", "t.html", "--stats", "s.json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(mFolder.contents(), (Names{"s.json", "t.html", "t.vdb"}));
    const std::string page = readText(mFolder / "t.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_EQ(page.find("@bandvox-"), std::string::npos);
    EXPECT_EQ(between(page, "<title>", "</title>"), "t.vdb");

    // What is shown are the voxels, as there is room for them.
    const Json header = Json::parse(headerText(page));
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdb(mFolder / "t.vdb").front());
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    const auto size = header.at("texture").at("size").get<std::vector<int>>();
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(size[axis], box.dim()[axis] + 2);
    const std::vector<double> values = valuesOf(page, header);
    std::size_t i = 0;
    double worst = 0;
    for (int z = 0; z < size[2]; ++z) {
        for (int y = 0; y < size[1]; ++y) {
            for (int x = 0; x < size[0]; ++x) {
                const openvdb::Coord voxel = box.min().offsetBy(x - 1, y - 1, z - 1);
                worst = std::max(worst, std::abs(values[i++] - grid->tree().getValue(voxel)));
            }
        }
    }
    // Halves have 11 bits.
    EXPECT_LT(worst, 1.01 / 4096);

    EXPECT_EQ(header.at("iso"), 0.5);
    EXPECT_EQ(header.at("inside"), "above");
    EXPECT_EQ(header.at("grid").at("bandvox").at("tolerance"), 1e-4);
    EXPECT_GT(header.at("grid").at("bandvox").at("source_volume").get<double>(), 0);
    double voxels = 0;
    for (const char* part : {"active", "inactive"}) {
        for (const Json& count : header.at("histogram").at(part)) voxels += count.get<double>();
    }
    EXPECT_EQ(voxels, static_cast<double>(box.volume()));
    EXPECT_EQ(header.at("spectrum").at("power").size(),
              static_cast<std::size_t>(RadialSpectrum::kShells));
    EXPECT_EQ(Json::parse(readText(mFolder / "s.json")).at("counts").at("samples"), values.size());
}

TEST_F(View, PageIsMadeOfTheSourcesThatAreThere) {
    const std::string root = build_places::sources();
    const RunResult digest = runProgram(
        {"/bin/sh", "-c",
         "LC_ALL=C; cat index.html package-lock.json tsconfig.json vite.config.js src/* | "
         "sha256sum"},
        {.folder = root + "/apps/view_page"});
    const std::string said = between(readText(root + "/apps/bandvox/view_page.html"),
                                     "<meta name=\"bandvox-sources\" content=\"", "\"");
    EXPECT_EQ(digest.out.substr(0, 64), said) << "scripts/build-view-page makes it anew";
}

TEST_F(View, PlacesTheSamplesInTheWorld) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->fill(openvdb::CoordBBox(openvdb::Coord(2, 4, 6), openvdb::Coord(11, 23, 35)), 2.0F);
    // Stretched, then turned by a right angle about z, then moved.
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->postScale(openvdb::Vec3d(1, 2, 3));
    transform->postRotate(std::acos(0.0), openvdb::math::Z_AXIS);
    transform->postTranslate(openvdb::Vec3d(100, 200, 300));
    grid->setTransform(transform);
    write("g.vdb", {grid});
    ASSERT_EQ(view({"g.vdb", "-o", "g.html", "--size", "512"}).status, 0);
    const Json header = Json::parse(headerText(readText(mFolder / "g.html")));
    const Json& texture = header.at("texture");
    const openvdb::Vec3d middle = transform->indexToWorld(openvdb::Vec3d(6.5, 13.5, 20.5));
    const openvdb::Vec3d steps[3] = {{0, 1, 0}, {-2, 0, 0}, {0, 0, 3}};
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(texture.at("center").at(axis).get<double>(), middle[axis], 1e-9);
        for (int part = 0; part < 3; ++part) {
            EXPECT_NEAR(texture.at("steps").at(axis).at(part).get<double>(), steps[axis][part],
                        1e-9);
        }
    }
    EXPECT_EQ(texture.at("linear"), true);
    EXPECT_EQ(texture.at("high"), 2);
}

TEST_F(View, ReducesWhatIsLarge) {
    convert("t.vdb");
    ASSERT_EQ(view({"t.vdb", "-o", "t.html", "--size", "16"}).status, 0);
    const std::string page = readText(mFolder / "t.html");
    const Json header = Json::parse(headerText(page));
    EXPECT_EQ(header.at("texture").at("size").at(0), 16);
    EXPECT_GT(header.at("texture").at("spacing").at(0).get<double>(), 2);
    EXPECT_EQ(valuesOf(page, header).size() % 16, 0u);
}

TEST_F(View, ShowsLevelSetsFromOutside) {
    const auto sphere =
        openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10, openvdb::Vec3f(0), 0.5F);
    write("s.vdb", {sphere});
    ASSERT_EQ(view({"s.vdb", "-o", "s.html"}).status, 0);
    const Json header = Json::parse(headerText(readText(mFolder / "s.html")));
    EXPECT_EQ(header.at("iso"), 0);
    EXPECT_EQ(header.at("inside"), "below");
    EXPECT_LT(header.at("texture").at("low").get<double>(), 0);
}

TEST_F(View, TextIsNeverTakenForHtml) {
    const std::string evil = "</title></script><script>alert(1)</script>&<!--\xFF\x01";
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().setValue(openvdb::Coord(0), 1.0F);
    grid->setName(evil);
    grid->insertMeta("note " + evil, openvdb::StringMetadata(evil));
    write("e.vdb", {grid});
    const RunResult result = view({"e.vdb", "-o", "e.html", "--title", evil});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string page = readText(mFolder / "e.html");
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.find('\xFF'), std::string::npos);
    EXPECT_EQ(page.find('\x01'), std::string::npos);
    const std::string shown = "</title></script><script>alert(1)</script>&<!--\xEF\xBF\xBD\x01";
    EXPECT_EQ(between(page, "<title>", "</title>"),
              "&lt;/title&gt;&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;&lt;!--"
              "\xEF\xBF\xBD ");
    const std::string text = headerText(page);
    for (const char c : {'<', '>', '&'}) EXPECT_EQ(text.find(c), std::string::npos) << c;
    const Json header = Json::parse(text);
    EXPECT_EQ(header.at("title"), shown);
    EXPECT_EQ(header.at("grid").at("name"), shown);
    EXPECT_EQ(header.at("grid").at("metadata").at("note " + shown), shown);
}

TEST_F(View, TakesTheGridAndIsoThatAreAskedFor) {
    writeSeveralGrids(mFolder / "several.vdb");
    ASSERT_EQ(view({"several.vdb", "-o", "a.html", "--grid", "heat", "--iso", "0.25"}).status, 0);
    const Json header = Json::parse(headerText(readText(mFolder / "a.html")));
    EXPECT_EQ(header.at("grid").at("name"), "heat");
    EXPECT_EQ(header.at("iso"), 0.25);
    const RunResult none = view({"several.vdb", "-o", "b.html", "--grid", "cold"});
    EXPECT_EQ(none.status, 3);
    EXPECT_NE(none.err.find("'cold'"), std::string::npos) << none.err;
    // Vectors are not shown.
    EXPECT_EQ(view({"several.vdb", "-o", "b.html", "--grid", "vel"}).status, 3);
    EXPECT_EQ(mFolder.contents(), (Names{"a.html", "several.vdb"}));
}

TEST_F(View, WarnsOfWhatIsNotSeen) {
    convert("t.vdb");
    const RunResult result = view({"t.vdb", "-o", "t.html", "--iso", "7"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(countLines(result.err, "bandvox: warning: no surface"), 1) << result.err;
    EXPECT_EQ(view({"t.vdb", "-o", "strict.html", "--iso", "7", "--strict"}).status, 4);
    auto grid = openvdb::FloatGrid::create(0.0F);
    grid->tree().setValue(openvdb::Coord(0), 1.0F);
    grid->tree().setValue(openvdb::Coord(3), std::numeric_limits<float>::quiet_NaN());
    write("n.vdb", {grid});
    const RunResult odd = view({"n.vdb", "-o", "n.html"});
    EXPECT_EQ(odd.status, 0);
    EXPECT_EQ(countLines(odd.err, "bandvox: warning: 1 value is not finite"), 1) << odd.err;
    EXPECT_EQ(mFolder.contents(), (Names{"n.html", "n.vdb", "t.html", "t.vdb"}));
}

TEST_F(View, ReadsTheStandardInputAndWritesToAPipe) {
    convert("t.vdb");
    const RunResult result = runProgram(
        {"/bin/sh", "-c", "\"$0\" view stdin.vdb -o /dev/stdout < t.vdb", build_places::command()},
        {.folder = mFolder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(Json::parse(headerText(result.out)).at("file"), "stdin.vdb");
}

TEST_F(View, IsTheSameForAnyNumberOfThreads) {
    convert("t.vdb");
    ASSERT_EQ(view({"t.vdb", "-o", "many.html"}).status, 0);
    ASSERT_EQ(view({"t.vdb", "-o", "one.html", "--threads", "1"}).status, 0);
    EXPECT_TRUE(readText(mFolder / "many.html") == readText(mFolder / "one.html"));
}

TEST_F(View, RefusesWhatItCannotShow) {
    convert("t.vdb");
    auto empty = openvdb::FloatGrid::create(0.0F);
    empty->setName("density");
    write("empty.vdb", {empty});
    writeText(mFolder / "damaged.vdb", "no vdb");
    const auto statusOf = [&](const Names& arguments, const RunOptions& options = {}) {
        const RunResult result = view(arguments, options);
        EXPECT_EQ(countLines(result.err, "bandvox: error: "), 1) << result.err;
        return result.status;
    };
    EXPECT_EQ(statusOf({"empty.vdb", "-o", "p.html"}), 4);
    EXPECT_EQ(statusOf({"damaged.vdb", "-o", "p.html"}), 3);
    EXPECT_EQ(statusOf({"missing.vdb", "-o", "p.html"}), 3);
    EXPECT_EQ(statusOf({"bunny.obj", "-o", "p.html"}), 3);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "p.png"}), 2);
    EXPECT_EQ(statusOf({"t.vdb"}), 2);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "p.html", "--size", "15"}), 2);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "p.html", "--size", "513"}), 2);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "p.html", "--iso", "nan"}), 2);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "missing/p.html"}), 1);
    // On a full disk nothing is left.
    EXPECT_EQ(statusOf({"t.vdb", "-o", "p.html"}, {.largestFile = 2000}), 1);
    EXPECT_EQ(statusOf({"t.vdb", "-o", "/dev/full"}), 1);
    EXPECT_EQ(mFolder.contents(), (Names{"damaged.vdb", "empty.vdb", "t.vdb"}));
}

}  // namespace
}  // namespace bandvox::app_test
