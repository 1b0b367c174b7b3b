#pragma once

#include <bandvox/source/read_patches.h>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdlib>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <iostream>
#include <sstream>
#include <string>

namespace bandvox::cad_test {

/// A folder of its own, removed at the end.
class PartFolder {
  public:
    PartFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "bandvox-cad-XXXXXX").string();
        if (mkdtemp(name.data())) mPath = name;
    }
    ~PartFolder() { std::filesystem::remove_all(mPath); }
    PartFolder(const PartFolder&) = delete;
    PartFolder& operator=(const PartFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return mPath / name; }

    /// Writes a shape as a file of this extension.
    std::filesystem::path write(const TopoDS_Shape& shape, const std::string& extension) const {
        const auto path = mPath / ("part" + extension);
        // Its writers talk.
        std::ostringstream said;
        std::streambuf* const before = std::cout.rdbuf(said.rdbuf());
        if (extension == ".brep") {
            BRepTools::Write(shape, path.c_str());
        } else if (extension == ".step") {
            STEPControl_Writer writer;
            writer.Transfer(shape, STEPControl_AsIs);
            writer.Write(path.c_str());
        } else {
            IGESControl_Writer writer("MM", 1);
            writer.AddShape(shape);
            writer.Write(path.c_str());
        }
        std::cout.rdbuf(before);
        return path;
    }

    /// Writes a compound as a STEP file with a product for each part and instances of them.
    std::filesystem::path writeAssembly(const TopoDS_Shape& shape) const {
        STEPControl_Controller::Init();
        Interface_Static::SetIVal("write.step.assembly", 1);
        const auto path = write(shape, ".step");
        Interface_Static::SetIVal("write.step.assembly", 0);
        return path;
    }

  private:
    std::filesystem::path mPath;
};

inline TopoDS_Shape cylinder(double radius, double height, const gp_Pnt& foot = {0, 0, 0},
                             const gp_Dir& axis = {0, 0, 1}) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(foot, axis), radius, height).Shape();
}

/// A 4 × 6 × 1 block around the z axis with a hole of radius 1 around (0.5, 0).
inline TopoDS_Shape drilledBlock() {
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-2, -3, 0), gp_Pnt(2, 3, 1)).Shape();
    return BRepAlgoAPI_Cut(block, cylinder(1, 3, {0.5, 0, -1})).Shape();
}

/// What a hole of radius 0.6 along the z axis leaves of a ball of radius 1.
inline TopoDS_Shape drilledBall() {
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(1).Shape(), cylinder(0.6, 4, {0, 0, -2})).Shape();
}

/// What two cylinders of radius 1, along z and x, have in common.
inline TopoDS_Shape crossedCylinders() {
    return BRepAlgoAPI_Common(cylinder(1, 4, {0, 0, -2}), cylinder(1, 4, {-2, 0, 0}, {1, 0, 0}))
        .Shape();
}

}  // namespace bandvox::cad_test
