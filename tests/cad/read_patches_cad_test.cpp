// Parts that Open CASCADE writes, read again: their volumes, and what is refused.

#include "cad/sample_parts.h"

#include <bandvox/core/error.h>
#include <bandvox/source/patch_solid.h>

#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <fstream>
#include <functional>
#include <gp_Ax1.hxx>
#include <gp_Lin.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>
#include <iterator>
#include <numbers>
#include <set>

namespace bandvox::cad_test {
namespace {

constexpr double kPi = std::numbers::pi;

std::string textOf(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void writeText(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

struct Part {
    const char* name;
    TopoDS_Shape shape;
    double volume, area;
};

std::vector<Part> parts() {
    const double slope = std::sqrt(13.0), half = 0.8;
    return {
        {"cylinder", cylinder(1, 3), 3 * kPi, 8 * kPi},
        {"ball", BRepPrimAPI_MakeSphere(1).Shape(), 4 * kPi / 3, 4 * kPi},
        {"torus", BRepPrimAPI_MakeTorus(2, 0.5).Shape(), kPi * kPi, 4 * kPi * kPi},
        {"cone", BRepPrimAPI_MakeCone(2, 0, 3).Shape(), 4 * kPi, kPi * 2 * slope + 4 * kPi},
        {"drilled block", drilledBlock(), 24 - kPi, 68},
        // A ball's zone has the area of a cylinder around it.
        {"drilled ball", drilledBall(), kPi * std::pow(2 * half, 3) / 6,
         2 * kPi * 2 * half + 2 * kPi * 0.6 * 2 * half},
        {"crossed cylinders", crossedCylinders(), 16.0 / 3, 16},
    };
}

TEST(ReadCadPatches, KeepsVolumesAndAreasInEveryKindOfFile) {
    const PartFolder folder;
    for (const char* const extension : {".step", ".iges", ".brep"}) {
        for (const Part& part : parts()) {
            const PatchModel model = readPatches(folder.write(part.shape, extension));
            const PatchSolid solid = makePatchSolid(part.name, model);
            EXPECT_NEAR(solid.source->volume(), part.volume, 1e-6 * part.volume)
                << part.name << extension;
            EXPECT_NEAR(solid.source->area(), part.area, 1e-6 * part.area)
                << part.name << extension;
            EXPECT_EQ(solid.report.piecesTurned, 0U) << part.name << extension;
        }
    }
}

TEST(ReadCadPatches, FindsTheBoxOfWhatIsLeft) {
    const PartFolder folder;
    // The ball's surface reaches to z = 1, what is left of it to 0.8.
    const PatchModel model = readPatches(folder.write(drilledBall(), ".step"));
    const openvdb::BBoxd box = makePatchSolid("ball", model).source->bounds();
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = axis < 2 ? 1 : 0.8;
        EXPECT_NEAR(box.max()[axis], reach, 1e-6);
        EXPECT_NEAR(box.min()[axis], -reach, 1e-6);
    }
}

TEST(ReadCadPatches, LeavesLoopsAwayThatGoAroundAllOfASurface) {
    const PartFolder folder;
    const PatchModel ball = readPatches(folder.write(BRepPrimAPI_MakeSphere(1).Shape(), ".brep"));
    for (const TrimmedFace& face : ball.topology.faces) EXPECT_TRUE(face.loops.empty());
    const PatchModel block = readPatches(folder.write(drilledBlock(), ".brep"));
    ASSERT_EQ(block.topology.faces.size(), 7U);
    std::size_t trimmed = 0;
    for (const TrimmedFace& face : block.topology.faces) trimmed += face.loops.empty() ? 0 : 1;
    EXPECT_EQ(trimmed, 2U);  // those with the hole's ends
    for (const FaceEdge& edge : block.topology.edges) EXPECT_EQ(edge.uses.size(), 2U);
}

// Both faces' curves of an edge are the same curve, and loops are closed.
TEST(ReadCadPatches, GivesEdgesTheSamePlacesOnBothFaces) {
    const PartFolder folder;
    for (const Part& part : parts()) {
        const PatchModel model = readPatches(folder.write(part.shape, ".step"));
        for (const FaceEdge& edge : model.topology.edges) {
            ASSERT_EQ(edge.uses.size(), 2U) << part.name;
            EXPECT_NE(edge.uses[0].isReversed, edge.uses[1].isReversed) << part.name;
            const auto placeOf = [&](const EdgeUse& use, double t) {
                for (const EdgePiece& piece : use.pieces) {
                    if (t > piece.to) continue;
                    // By de Casteljau's scheme.
                    ParameterCurve p = piece.curve;
                    const double s = (t - piece.from) / (piece.to - piece.from);
                    for (std::size_t rest = p.size() - 1; rest > 0; --rest) {
                        for (std::size_t i = 0; i < rest; ++i) {
                            for (std::size_t c = 0; c < 2; ++c) {
                                p[i][c] += s * (p[i + 1][c] - p[i][c]);
                            }
                        }
                    }
                    const auto& patch = model.patches[static_cast<std::size_t>(piece.patch)];
                    return openvdb::Vec3d(evaluate(patch, p[0][0], p[0][1]).position.data());
                }
                return openvdb::Vec3d(1e300);
            };
            for (const double t : {0.0, 0.21, 0.5, 0.83, 1.0}) {
                EXPECT_LT((placeOf(edge.uses[0], t) - placeOf(edge.uses[1], t)).length(), 2e-7)
                    << part.name << " at " << t;
            }
        }
    }
}

TEST(ReadCadPatches, MakesAnObjectOfEachSolid) {
    const PartFolder folder;
    const BRep_Builder builder;
    TopoDS_Compound two;
    builder.MakeCompound(two);
    builder.Add(two, cylinder(1, 1));
    builder.Add(two, cylinder(1, 1, {5, 0, 0}));
    const PatchModel model = readPatches(folder.write(two, ".brep"));
    EXPECT_EQ(model.objects, (std::vector<std::string>{"part", "part"}));
    EXPECT_EQ(model.patches.back().object, 1);
    const PatchSolid solid = makePatchSolid("two", model);
    EXPECT_EQ(solid.report.pieces, 2U);
    EXPECT_NEAR(solid.source->volume(), 2 * kPi, 1e-5);
}

// Two pairs of one bolt: the file has the bolt once, two places for it in a pair, and two for that.
TEST(ReadCadPatches, NamesTheSamePartByItsInstances) {
    const PartFolder folder;
    const BRep_Builder builder;
    const auto placed = [](const TopoDS_Shape& shape, const gp_Vec& by) {
        gp_Trsf move;
        move.SetTranslation(by);
        return shape.Moved(TopLoc_Location(move));
    };
    const TopoDS_Shape bolt = cylinder(1, 1);
    TopoDS_Compound pair, all;
    builder.MakeCompound(pair);
    builder.Add(pair, placed(bolt, {0, 0, 0}));
    builder.Add(pair, placed(bolt, {5, 0, 0}));
    builder.MakeCompound(all);
    builder.Add(all, placed(pair, {0, 10, 0}));
    builder.Add(all, placed(pair, {0, 20, 0}));
    const auto path = folder.writeAssembly(all);
    std::string text = textOf(path);
    const std::string use = "NEXT_ASSEMBLY_USAGE_OCCURRENCE('";
    const std::set<std::string> names{"bolt:1", "bolt:2", "pair:1", "pair:2"};
    std::size_t at = 0;
    for (const std::string& name : names) {
        at = text.find(use, at);
        ASSERT_NE(at, std::string::npos) << text;
        const std::size_t id = text.find("','", at) + 3, end = text.find("',", id);
        text.replace(id, end - id, name);
        at = id;
    }
    EXPECT_EQ(text.find(use, at), std::string::npos);
    writeText(path, text);
    const PatchModel model = readPatches(path);
    // Which of them the file has first is its writer's affair.
    ASSERT_EQ(model.objects.size(), 4U);
    std::set<std::string> found(model.objects.begin(), model.objects.end()), parts;
    EXPECT_EQ(found.size(), 4U);
    for (const std::string& object : model.objects) {
        const std::size_t slash = object.find('/');
        ASSERT_NE(slash, std::string::npos) << object;
        parts.insert(object.substr(0, slash));
        parts.insert(object.substr(slash + 1));
    }
    EXPECT_EQ(parts, names);
    const PatchSolid solid = makePatchSolid("bolts", model);
    EXPECT_NEAR(solid.source->volume(), 4 * kPi, 1e-5);
    const openvdb::BBoxd box = solid.source->bounds();
    EXPECT_NEAR(box.max()[1], 21, 1e-6);
}

// A model is the same wherever it comes in a scene.
TEST(ReadCadPatches, AppendsModels) {
    const PartFolder folder;
    const PatchModel block = readPatches(folder.write(drilledBlock(), ".brep"));
    PatchModel scene;
    scene.append(block);
    scene.append(block);
    const PatchSolid solid = makePatchSolid("scene", scene);
    EXPECT_EQ(solid.report.pieces, 2U);
    EXPECT_NEAR(solid.source->volume(), 2 * (24 - kPi), 1e-5);
}

// Adds an entity to the text of a STEP file.
auto withProperty(const std::string& entity) {
    return [entity](const std::string& text) {
        const std::string data = "DATA;";
        return std::string(text).insert(text.find(data) + data.size(), "\n#900001=" + entity + ";");
    };
}

// A shape, and an edge that is all of a line.
TopoDS_Shape withAxis(const TopoDS_Shape& shape) {
    const BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    builder.Add(all, shape);
    builder.Add(all, BRepBuilderAPI_MakeEdge(gp_Lin(gp_Ax1())).Edge());
    return all;
}

ErrorKind kindOf(const std::function<void()>& work, std::string& message) {
    try {
        work();
    } catch (const Error& error) {
        message = error.what();
        return error.kind();
    }
    ADD_FAILURE() << "no error";
    return ErrorKind::Interrupted;
}

TEST(ReadCadPatches, RefusesWhatIsNoWholeFile) {
    const PartFolder folder;
    struct Broken {
        std::string extension;
        std::function<std::string(const std::string&)> change;
    };
    const auto first = [](double share) {
        return [share](const std::string& text) {
            return text.substr(0,
                               static_cast<std::size_t>(share * static_cast<double>(text.size())));
        };
    };
    const auto all = [](const std::string& text) {
        return [text](const std::string&) { return text; };
    };
    const auto changed = [](const std::string& from, const std::string& to) {
        return [from, to](const std::string& text) {
            const std::size_t at = text.find(from);
            return std::string(text).replace(at, from.size(), to);
        };
    };
    const std::vector<Broken> broken{
        {".step", changed("VECTOR('',#", "VECTOR('',#99999")},
        {".step", changed("CARTESIAN_POINT('',(0.,", "CARTESIAN_POINT('',(NAN,")},
        {".brep", changed("Curve2ds ", "Curve2ds 10000000")},
        {".brep", changed("\n1 0 0 ", "\n1 nan 0 ")},
        {".brep", changed("\n1  1 0 0 ", "\n1  1 1e6 0 ")},
        {".brep", changed("\n1  1 0 0 ", "\n1  1 1e300 0 ")},
        {".brep", changed("\n1 0 0 ", "\n1 1e300 0 ")},
        {".brep", changed("\n1 0 0 ", "\n1 -1e22 0 ")},
        {".step", changed("CARTESIAN_POINT('',(0.,", "CARTESIAN_POINT('',(1.E300,")},
        {".step", changed("CARTESIAN_POINT('',(0.,", "CARTESIAN_POINT('',(-2.E12,")},
        {".step", changed("CARTESIAN_POINT('',(0.,", "CARTESIAN_POINT('',(20000000000000,")},
        {".step", withProperty("MEASURE_WITH_UNIT(VOLUME_MEASURE(1.E+30),#1)")},
        {".step", withProperty("LENGTH_MEASURE_WITH_UNIT(VOLUME_MEASURE(1.5E+13),#1)")},
        {".step", withProperty("CARTESIAN_POINT('',(0.1E" + std::string(90, '0') + "14,0.,0.))")},
        {".step", withProperty("CARTESIAN_POINT('',(" + std::string(90, '9') + ".,0.,0.))")},
        {".step", withProperty("CARTESIAN_POINT('',(1" + std::string(400, '0') + ".E-9,0.,0.))")},
        {".brep", changed("\n1 0 0 ", "\n1 2e+100 0 ")},
        {".brep", changed("\n1  1 0 0 ", "\n1  1 0 -1e+99 ")},
        {".iges", changed("123,1.,0.,-0.;", "123,1.D300,0.;")},
        {".iges", changed("123,1.,0.,-0.;", "123,1.E300,0.,-0.;")},
        {".step", first(0)},
        {".step", first(0.5)},
        {".step", all("solid\nendsolid\n")},
        {".step", all("ISO-10303-21;\nEND-ISO-10303-21;\n")},
        {".step",
         all("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=(((;\nENDSEC;\nEND-ISO-10303-21;")},
        {".iges", first(0)},
        {".iges", first(0.5)},
        {".iges", all("ISO-10303-21;\n")},
        {".brep", first(0)},
        {".brep", first(0.3)},
        {".brep", first(0.6)},
        {".brep", all("solid\nendsolid\n")},
    };
    for (const Broken& file : broken) {
        const auto path = folder.write(cylinder(1, 2), file.extension);
        writeText(path, file.change(textOf(path)));
        std::string message;
        EXPECT_EQ(kindOf([&] { readPatches(path); }, message), ErrorKind::Input) << message;
        EXPECT_NE(message.find(path.string()), std::string::npos) << message;
        EXPECT_NE(message.find("expected"), std::string::npos) << message;
    }
    std::string message;
    EXPECT_EQ(kindOf([&] { readPatches(folder / "none.step"); }, message), ErrorKind::Input);
}

// Neither what is said of a part besides its shape, nor what is no number, has to be in range.
TEST(ReadCadPatches, TakesLargeNumbersThatAreNoLengths) {
    const PartFolder folder;
    const std::string digits(91, '7');
    const std::vector<std::string> properties{
        "MEASURE_REPRESENTATION_ITEM('',VOLUME_MEASURE(1.5E+13),#1)",
        "(MEASURE_REPRESENTATION_ITEM()MEASURE_WITH_UNIT(AREA_MEASURE(1.5E+13),#1)"
        "REPRESENTATION_ITEM(''))",
        "INTEGER_REPRESENTATION_ITEM('id',20240101123456)",
        "REAL_REPRESENTATION_ITEM('',1.5E+300)",
        "BINARY_ITEM('',\"0123456789012345678\")",
        "CARTESIAN_POINT('',(0.1" + digits + ",-12.3" + digits + "E-1,0.))",
        "CARTESIAN_POINT('',(1.E-400,-0." + std::string(400, '0') + "1,0.))",
        "CARTESIAN_POINT('',(0.E+400,0." + std::string(400, '0') + "1E+300,0.))"};
    const auto path = folder.write(cylinder(1, 2), ".step");
    const std::string text = textOf(path);
    for (const std::string& property : properties) {
        writeText(path, withProperty(property)(text));
        try {
            EXPECT_NEAR(makePatchSolid("part", readPatches(path)).source->volume(), 2 * kPi, 1e-5);
        } catch (const Error& error) {
            ADD_FAILURE() << property << ": " << error.what();
        }
    }
}

// Open CASCADE writes them so; no face need have them.
TEST(ReadCadPatches, TakesEdgesWithoutEnds) {
    const PartFolder folder;
    const auto path = folder.write(withAxis(cylinder(1, 2)), ".brep");
    const std::string text = textOf(path);
    ASSERT_NE(text.find(" -2e+100 2e+100"), std::string::npos) << text;
    EXPECT_NEAR(makePatchSolid("part", readPatches(path)).source->volume(), 2 * kPi, 1e-5);
}

// What stands in names is no number.
TEST(ReadCadPatches, TakesNamesAsTheyAre) {
    const PartFolder folder;
    const auto path = folder.write(cylinder(1, 2), ".step");
    std::string text = textOf(path);
    const std::string solid = "MANIFOLD_SOLID_BREP('";
    const std::size_t at = text.find(solid) + solid.size();
    text.replace(at, text.find('\'', at) - at, "1E400 nan #77");
    writeText(path, text);
    EXPECT_EQ(readPatches(path).objects, std::vector<std::string>{"1E400 nan #77"});
}

TEST(ReadCadPatches, WarnsOfWhatIsNotKnown) {
    const PartFolder folder;
    const auto path = folder.write(cylinder(1, 2), ".step");
    std::string text = textOf(path);
    const std::string face = "ADVANCED_FACE";
    text.replace(text.find(face), face.size(), "FOO_FACE");
    writeText(path, text);
    const PatchModel model = readPatches(path);
    ASSERT_EQ(model.warnings.size(), 1U);
    EXPECT_NE(model.warnings[0].find("does not know were left out: 1"), std::string::npos);
}

TEST(ReadCadPatches, RefusesToFillWhatIsOpen) {
    const PartFolder folder;
    const TopoDS_Shape shape = cylinder(1, 2);
    const PatchModel face =
        readPatches(folder.write(TopExp_Explorer(shape, TopAbs_FACE).Current(), ".brep"));
    std::string message;
    EXPECT_EQ(kindOf([&] { makePatchSolid("face", face); }, message), ErrorKind::Result);
    EXPECT_NE(message.find("open"), std::string::npos) << message;
    const PatchModel whole = readPatches(folder.write(shape, ".brep"));
    EXPECT_EQ(kindOf([&] { makePatchSolid("part", whole, {.base = 0.0}); }, message),
              ErrorKind::Usage);
}

}  // namespace
}  // namespace bandvox::cad_test
