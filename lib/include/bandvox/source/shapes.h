#pragma once

#include <bandvox/source/boundary_source.h>
#include <bandvox/source/field_source.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

/// Names of the built-in shapes: "hyperboloid", "sphere", "cube", "torus", "two-balls", "tree".
/// Each fits the box [-1, 1]³ and has its longest side there.
const std::vector<std::string>& shapeNames();

/// True if `input` starts with "shape:".
bool isShape(std::string_view input);

/// The boundary of a built-in shape, exactly (curved patches, no tessellation). `input` is
/// "shape:NAME". Throws Error(ErrorKind::Input) for an unknown name, listing the known ones.
std::unique_ptr<BoundarySource> makeShapeBoundary(std::string_view input);

/// The same solid as a formula: 1 inside, 0 outside. Throws as makeShapeBoundary.
std::unique_ptr<FieldSource> makeShapeField(std::string_view input);

}  // namespace bandvox
