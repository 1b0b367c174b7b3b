#pragma once

#include "source/cad_library.h"

#include <TopoDS_Shape.hxx>
#include <functional>
#include <string>

namespace bandvox {

/// Gives a solid or a shell its name; empty if it has none.
using ShapeNames = std::function<std::string(const TopoDS_Shape&)>;

/// The faces of a shape, as B-spline surfaces and the wires around them. Each solid is an object,
/// and so is each shell outside of solids. Throws Error(ErrorKind::Input) for what cannot be made
/// patches. May throw Standard_Failure.
CadShape facesOf(const TopoDS_Shape& shape, const ShapeNames& names, const InterruptCheck& check);

}  // namespace bandvox
