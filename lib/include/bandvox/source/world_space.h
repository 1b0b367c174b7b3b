#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Mat4.h>

#include <optional>
#include <string>

namespace bandvox {

/// The name of a space of scans, by where its axes point: of "LPS", "left-posterior-superior" and
/// the same in other cases "left-posterior-superior", likewise RAS and LAS; other words as they
/// are.
std::string worldSpaceName(const std::string& words);

/// The world of one space in another, acting on rows: a change of signs. Nothing unless both are
/// spaces of scans.
std::optional<openvdb::Mat4d> spaceToSpace(const std::string& from, const std::string& to);

/// Where the axes of an array come from, as MetaImage's AnatomicalOrientation has it: "RAI" if x
/// runs from right to left, y from anterior to posterior and z from inferior to superior. Of
/// oblique axes the nearest, each direction once. `toWorld` acts on rows, and its world is
/// left-posterior-superior.
std::string axesFrom(const openvdb::Mat4d& toWorld);

}  // namespace bandvox
