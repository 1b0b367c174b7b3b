// What the outline command draws, and how it writes that.

#include "outline_inputs.h"
#include "run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::app_test {
namespace {

TEST(Outline, DrawsTheTeapotWithFewAnchors) {
    const TemporaryFolder folder;
    const RunResult result =
        runBandvox({"outline", kTeapotFile, "-o", "teapot.svg", "--up", "0,0,1", "--from", "1,-2,1",
                    "--tolerance", "0.01", "--stats", "stats.json"},
                   {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    EXPECT_LE(stats["counts"]["visible_anchors"], 200);
    EXPECT_GE(stats["counts"]["visible_paths"], 10);
    const std::string svg = readText(folder / "teapot.svg");
    for (const char* word :
         {"width=\"200mm\" height=\"150mm\" viewBox=\"0 0 200 150\"", "inkscape:label=\"teapot\"",
          "id=\"visible-contour-1\"", "class=\"hidden intersection\"", "stroke-dasharray: 1.2 0.8",
          "inkscape:groupmode=\"layer\"", "id=\"visible-boundary-1\""}) {
        EXPECT_NE(svg.find(word), std::string::npos) << word;
    }
    EXPECT_EQ(svg.find("clip"), std::string::npos);
    EXPECT_EQ(occurrences(svg, "<g "), occurrences(svg, "</g>"));
    // The same again, byte by byte, whatever the number of threads.
    ASSERT_EQ(runBandvox({"outline", kTeapotFile, "-o", "again.svg", "--up", "0,0,1", "--from",
                          "1,-2,1", "--threads", "1"},
                         {.folder = folder.path()})
                  .status,
              0);
    EXPECT_EQ(readText(folder / "again.svg"), svg);
}

TEST(Outline, HasPagesAndKinds) {
    const TemporaryFolder folder;
    const auto outline = [&](Names more) {
        more.insert(more.begin(), {"outline", kTeapotFile, "-o", "out.svg", "--up", "0,0,1"});
        return runBandvox(more, {.folder = folder.path()});
    };
    ASSERT_EQ(outline({"--page", "A4-landscape", "--no-hidden", "--kinds", "contour", "--stroke",
                       "0.5", "--stroke-color", "rgb(1, 2, 3)"})
                  .status,
              0);
    const std::string svg = readText(folder / "out.svg");
    EXPECT_NE(svg.find("width=\"297mm\" height=\"210mm\""), std::string::npos);
    EXPECT_NE(svg.find("stroke: rgb(1, 2, 3); stroke-width: 0.5"), std::string::npos);
    EXPECT_EQ(svg.find("class=\"hidden"), std::string::npos);
    EXPECT_EQ(svg.find("visible boundary"), std::string::npos);
    for (const Names& wrong : {Names{"--page", "A9"},
                               {"--page", "10x"},
                               {"--page", "-3x4"},
                               {"--tolerance", "0"},
                               {"--kinds", "edge"},
                               {"--stroke-color", "red;} svg {"},
                               {"--margin", "75"},
                               {"--light", "0,0,0"},
                               {"--frame", "3"},
                               {"--page", "0.5x10"},
                               {"--stroke", "0.00001"},
                               {"--dash", "0.00001 0.00001"},
                               {"--eye", "0.1,0,1"}}) {
        EXPECT_EQ(outline(wrong).status, 2) << wrong[1];
    }
}

TEST(Outline, WritesPdfAndEps) {
    const TemporaryFolder folder;
    const auto outline = [&](const std::string& output, Names more) {
        more.insert(more.begin(), {"outline", kTeapotFile, "-o", output, "--up", "0,0,1"});
        return runBandvox(more, {.folder = folder.path()}).status;
    };
    ASSERT_EQ(outline("out.svg", {}), 0);
    const std::string svg = readText(folder / "out.svg");
    ASSERT_EQ(outline("out.pdf", {"--stroke-color", "#f00"}), 0);
    const std::string pdf = readText(folder / "out.pdf");
    EXPECT_EQ(occurrences(pdf, " c\n"), occurrences(svg, " C"));
    EXPECT_EQ(occurrences(pdf, "/Type /OCG"), occurrences(svg, "class=\""));
    EXPECT_NE(pdf.find("/MediaBox [0 0 566.9291 425.1969]"), std::string::npos);
    EXPECT_NE(pdf.find("1 0 0 RG"), std::string::npos);
    // Every object is where the table says, and the table where the end says.
    const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
    ASSERT_EQ(pdf.compare(table, 5, "xref\n"), 0);
    const std::size_t entries = pdf.find("65535 f \n", table) + 9;
    for (std::size_t k = 0; k < occurrences(pdf, " 0 obj\n"); ++k) {
        const std::size_t start = std::stoul(pdf.substr(entries + 20 * k, 10));
        const std::string head = std::to_string(k + 1) + " 0 obj";
        EXPECT_EQ(pdf.compare(start, head.size(), head), 0) << k;
    }
    ASSERT_EQ(outline("out.eps", {}), 0);
    const std::string eps = readText(folder / "out.eps");
    EXPECT_EQ(occurrences(eps, " curveto\n"), occurrences(svg, " C"));
    EXPECT_NE(eps.find("%%BoundingBox: 0 0 567 426"), std::string::npos);
    EXPECT_EQ(outline("bad.pdf", {"--stroke-color", "red"}), 2);
    EXPECT_EQ(outline("bad.eps", {"--dash", "none"}), 2);
}

// The values that follow a group code in a DXF file, by code.
std::vector<std::pair<int, std::string>> dxfGroups(const std::string& text) {
    std::vector<std::pair<int, std::string>> groups;
    std::istringstream lines(text);
    for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);) {
        groups.emplace_back(std::stoi(code), value);
    }
    return groups;
}

TEST(Outline, WritesTheCurvesOfAnSvgAsSplinesOfADxf) {
    const TemporaryFolder folder;
    const auto outline = [&](const std::string& output, Names more) {
        more.insert(more.begin(), {"outline", kTeapotFile, "-o", output, "--up", "0,0,1"});
        return runBandvox(more, {.folder = folder.path()}).status;
    };
    ASSERT_EQ(outline("out.svg", {}), 0);
    ASSERT_EQ(outline("out.dxf", {}), 0);
    const std::string svg = readText(folder / "out.svg");
    std::vector<double> expected;  // x, and y upward, of all control points
    const std::regex path(" d=\"([^\"]*)\"");
    for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it) {
        std::string numbers = (*it)[1];
        for (char& c : numbers) {
            if (c == ',' || std::isalpha(static_cast<unsigned char>(c)) != 0) c = ' ';
        }
        std::istringstream words(numbers);
        for (double x = 0, y = 0; words >> x >> y;) {
            expected.push_back(x);
            expected.push_back(150 - y);
        }
    }
    std::vector<double> found;
    std::vector<std::string> handles, layers;
    std::map<std::string, int> splines;  // by layer
    std::string type;
    int closed = 0;
    for (const auto& [code, value] : dxfGroups(readText(folder / "out.dxf"))) {
        if (code == 0) type = value;
        if (code == 5 && type != "SECTION") handles.push_back(value);
        if (type == "LAYER" && code == 2) layers.push_back(value);
        if (type != "SPLINE") continue;
        if (code == 8) ++splines[value];
        if (code == 70) closed += std::stoi(value) & 1;
        if (code == 10 || code == 20) found.push_back(std::stod(value));
    }
    ASSERT_EQ(found.size(), expected.size());
    ASSERT_GT(found.size(), 500U);
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 2e-4) << i;
    EXPECT_EQ(static_cast<std::size_t>(closed), occurrences(svg, " Z\"/>"));
    EXPECT_EQ(splines.size(), occurrences(svg, " class=\""));
    for (const auto& [layer, count] : splines) {
        EXPECT_EQ(std::count(layers.begin(), layers.end(), layer), 1) << layer;
    }
    EXPECT_EQ(splines.count("teapot 1 visible contour"), 1U);
    std::sort(handles.begin(), handles.end());
    EXPECT_EQ(std::adjacent_find(handles.begin(), handles.end()), handles.end());
    // Of an odd number of dashes there are two turns.
    ASSERT_EQ(outline("odd.dxf", {"--dash", "3 1 2"}), 0);
    std::vector<std::string> dashes;
    for (const auto& [code, value] : dxfGroups(readText(folder / "odd.dxf"))) {
        if (code == 49) dashes.push_back(value);
    }
    EXPECT_EQ(dashes, (Names{"3", "-1", "2", "-3", "1", "-2"}));
    // What it cannot hold is refused before anything is drawn.
    EXPECT_EQ(outline("bad.dxf", {"--fill", "flat"}), 2);
    EXPECT_EQ(outline("bad.dxf", {"--stroke-color", "red"}), 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "bad.dxf"));
}

TEST(Outline, ReadsFreeFormSurfacesOfObjFiles) {
    const TemporaryFolder folder;
    writeText(folder / "cylinder.obj", kCylinder);
    const RunResult result =
        runBandvox({"outline", "cylinder.obj", "-o", "out.svg"}, {.folder = folder.path()});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(readText(folder / "out.svg").find("boundary"), std::string::npos);
    // A uniform cubic B-spline with 4 x 4 points, turned into one patch.
    std::ostringstream net;
    for (int k = 0; k < 16; ++k) net << "v " << k % 4 << " " << k / 4 << " " << k % 3 << "\n";
    net << "o first\ncstype bspline\ndeg 3 3\nsurf 3 4 3 4";
    for (int k = 0; k < 16; ++k) net << " " << k - 16;
    net << "\nparm u 0 1 2 3 4 5 6 7\nparm v 0 1 2 3 \\\n4 5 6 7\nend\n";
    writeText(folder / "net.obj", net.str());
    const RunResult both = runBandvox({"outline", "net.obj", "cylinder.obj", "-o", "out.svg"},
                                      {.folder = folder.path()});
    ASSERT_EQ(both.status, 0) << both.err;
    const std::string svg = readText(folder / "out.svg");
    EXPECT_NE(svg.find("inkscape:label=\"first\""), std::string::npos);
    EXPECT_NE(svg.find("inkscape:label=\"cylinder\""), std::string::npos);
}

TEST(Outline, DrawsVolumesMeshesAndShapes) {
    const TemporaryFolder folder;
    const auto run = [&](const Names& words) {
        return runBandvox(words, {.folder = folder.path()});
    };
    ASSERT_EQ(run({"convert", "shape:torus", "-r", "48", "-o", "torus.vdb"}).status, 0);
    ASSERT_EQ(run({"convert", "shape:torus", "-r", "48", "-o", "torus.obj"}).status, 0);
    const RunResult volume = run({"outline", "torus.vdb", "-o", "volume.svg"});
    ASSERT_EQ(volume.status, 0) << volume.err;
    ASSERT_EQ(
        run({"outline", "shape:torus", "-r", "48", "-o", "shape.svg", "--threads", "1"}).status, 0);
    const auto labelled = [&](const std::string& name, const std::string& label) {
        std::string svg = readText(folder / name);
        const std::string word = "inkscape:label=\"" + label + "\"";
        const std::size_t at = svg.find(word);
        EXPECT_NE(at, std::string::npos) << name;
        return svg.erase(at, at == std::string::npos ? 0 : word.size());
    };
    // A shape is made the same volume.
    const std::string drawn = labelled("volume.svg", "torus");
    EXPECT_EQ(drawn, labelled("shape.svg", "shape:torus"));
    EXPECT_EQ(occurrences(drawn, "class=\"visible contour\""), 1U);
    EXPECT_EQ(occurrences(drawn, "class=\"hidden contour\""), 1U);
    const RunResult mesh = run({"outline", "torus.obj", "examples.bpt", "-o", "mesh.svg"});
    EXPECT_EQ(mesh.status, 3);
    const RunResult mixed = run({"outline", "torus.obj", kTeapotFile, "-r", "48", "--isophotes",
                                 "0.2,0.6", "--iso", "volume", "-o", "mixed.pdf"});
    ASSERT_EQ(mixed.status, 0) << mixed.err;
    EXPECT_NE(readText(folder / "mixed.pdf").find("isophote"), std::string::npos);
}

TEST(Outline, FillsWhatIsBetweenLines) {
    const TemporaryFolder folder;
    const auto run = [&](const Names& words) {
        return runBandvox(words, {.folder = folder.path()});
    };
    const RunResult flat = run({"outline", kTeapotFile, "-o", "flat.svg", "--fill", "flat",
                                "--fill-colors", "#abc,#123456", "--up", "0,0,1"});
    ASSERT_EQ(flat.status, 0) << flat.err;
    const std::string svg = readText(folder / "flat.svg");
    EXPECT_EQ(occurrences(svg, "fill=\"#aabbcc\""), occurrences(svg, "class=\"tone-0\""));
    EXPECT_GE(occurrences(svg, "class=\"tone-0\""), 1U);
    EXPECT_LT(svg.find("id=\"fills\""), svg.find("id=\"object-1\""));
    for (const char* const name : {"toon.svg", "toon.pdf", "toon.eps"}) {
        const RunResult toon = run({"outline", kTeapotFile, "-o", name, "--fill", "toon", "--tones",
                                    "0.1,0.5,0.9", "--shade", "0", "--no-hidden"});
        ASSERT_EQ(toon.status, 0) << toon.err;
        EXPECT_NE((toon.out + toon.err).find("regions"), std::string::npos);
    }
    const std::string tones = readText(folder / "toon.svg");
    for (const char* const tone : {"tone-0", "tone-1", "tone-2", "tone-3"}) {
        EXPECT_NE(tones.find(tone), std::string::npos) << tone;
    }
    EXPECT_NE(tones.find("fill=\"#000000\""), std::string::npos);
    EXPECT_EQ(tones.find("isophote"), std::string::npos);
    EXPECT_NE(readText(folder / "toon.pdf").find("\nB*\n"), std::string::npos);
    EXPECT_NE(readText(folder / "toon.eps").find("eofill"), std::string::npos);
    // Fills alone, without a line.
    EXPECT_EQ(
        run({"outline", kTeapotFile, "-o", "bare.svg", "--fill", "flat", "--kinds", "isophote"})
            .status,
        0);
    for (const Names& words :
         {Names{"--fill", "plaid"}, Names{"--fill-colors", "#123"}, Names{"--tones", "0.5"},
          Names{"--fill", "toon", "--tones", "0.5,0.2"}, Names{"--fill", "flat", "--shade", "0.5"},
          Names{"--fill", "flat", "--fill-colors", "red"},
          Names{"--fill", "flat", "--fill-colors", "#123,"}, Names{"--dash", "-1,2"},
          Names{"--tolerance", "1e-12"}}) {
        Names all{"outline", kTeapotFile, "-o", "wrong.svg"};
        all.insert(all.end(), words.begin(), words.end());
        EXPECT_EQ(run(all).status, 2) << words.back();
    }
}

// The paths of an SVG file, and their ids.
std::map<std::string, std::string> pathsOf(const std::string& svg) {
    const auto attribute = [](const std::string& tag, const std::string& name) {
        std::smatch found;
        const std::regex pattern("\\s" + name + "=\"([^\"]*)\"");
        return std::regex_search(tag, found, pattern) ? found[1].str() : std::string();
    };
    std::map<std::string, std::string> paths;
    for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at)) {
        const std::size_t end = svg.find('>', at);
        const std::string tag = svg.substr(at, end - at);
        paths[attribute(tag, "id")] = attribute(tag, "class") + attribute(tag, "d");
        at = end;
    }
    return paths;
}

TEST(Outline, SurvivesInkscape) {
    if (!hasProgram("inkscape")) GTEST_SKIP() << "there is no inkscape";
    const TemporaryFolder folder;
    ASSERT_EQ(
        runBandvox({"outline", kTeapotFile, "-o", "drawing.svg", "--up", "0,0,1", "--fill", "toon"},
                   {.folder = folder.path()})
            .status,
        0);
    const RunResult saved =
        runProgram({"inkscape", "drawing.svg", "--export-type=svg", "--export-filename=again.svg"},
                   {.folder = folder.path()});
    ASSERT_EQ(saved.status, 0) << saved.err;
    const std::string before = readText(folder / "drawing.svg");
    const std::string after = readText(folder / "again.svg");
    EXPECT_GT(pathsOf(before).size(), 30U);
    EXPECT_EQ(pathsOf(before), pathsOf(after));
    EXPECT_EQ(occurrences(before, "inkscape:groupmode=\"layer\""),
              occurrences(after, "inkscape:groupmode=\"layer\""));
}

}  // namespace
}  // namespace bandvox::app_test
