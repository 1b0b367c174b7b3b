#pragma once

#include <filesystem>
#include <string>

namespace bandvox::app_test {

/// A cube [-1, 1]³ as an obj: 8 points, 6 quadrilaterals, outward.
std::string cubeObj();
/// The same without the face at z = 1: one hole of four edges.
std::string openCubeObj();
/// The same cube; its points are red below, at z = -1, and blue above.
std::string coloredCubeObj();
/// The same cube, triangles only, as text of other formats.
std::string cubePly();
std::string cubeStlAscii();
std::string cubeStlBinary();
/// The same as a glTF binary.
std::string cubeGlb();
/// The same as Assimp exports it to a format of this name in its own list, such as "collada"; one
/// that it writes to a single file.
std::string exportedCube(const std::string& format);

/// Writes a .vdb with a float grid "density", a float grid "heat", a vector grid "vel" with one
/// voxel each, and an empty bool grid "mask".
void writeSeveralGrids(const std::filesystem::path& path);

/// Writes a .vdb with a small float grid that can be drawn; its name has a line break and a code
/// that colours a terminal.
void writeOddlyNamedGrid(const std::filesystem::path& path);

}  // namespace bandvox::app_test
