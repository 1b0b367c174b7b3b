// What bandvox.bandlimit does of a closed mesh's file, in C++ alone: prints the seconds of each
// call.
//
//   mesh_seconds MESH RESOLUTION CALLS

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/unite_shells.h>

#include <openvdb/openvdb.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <utility>

namespace {

void makeDensity(const std::string& path, int resolution) {
    using namespace bandvox;
    MeshFile file = readMesh(path);
    ClosedMesh closed = closeMesh(std::move(file.mesh), {.capping = Capping::Sensible});
    UnitedMesh united = uniteShells(std::move(closed.mesh));
    surfaceToDensity(MeshSource(path, std::move(united.mesh)), {.resolution = resolution});
}

}  // namespace

int main(int count, char** words) {
    if (count != 4) {
        std::cerr << "usage: mesh_seconds MESH RESOLUTION CALLS\n";
        return 2;
    }
    openvdb::initialize();
    try {
        for (int i = 0; i < std::atoi(words[3]); ++i) {
            const auto start = std::chrono::steady_clock::now();
            makeDensity(words[1], std::atoi(words[2]));
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
            std::cout << taken.count() << '\n';
        }
    } catch (const std::exception& error) {
        std::cerr << "mesh_seconds: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
