#pragma once

#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS_Shape.hxx>
#include <Transfer_TransientProcess.hxx>
#include <string>
#include <vector>

namespace bandvox {

/// The names that a STEP file gives to what it places: a part that is there several times has a
/// name for each place, of the assembly's instances from the outermost one on, as in
/// "left wheel/bolt:3". An instance without a name is called by its product's.
class InstanceNames {
  public:
    /// `whole`: what was made of the file.
    InstanceNames(const Handle(Transfer_TransientProcess) & process, const TopoDS_Shape& whole);

    /// Of a solid or a shell; empty if it is none of an instance.
    std::string nameOf(const TopoDS_Shape& part) const;

  private:
    void walk(const TopoDS_Shape& shape, const TopLoc_Location& place, const std::string& path);

    // Shapes are the same if they are in the same place.
    TopTools_DataMapOfShapeInteger mInstances, mParts;
    std::vector<std::string> mNames, mPaths;
};

}  // namespace bandvox
