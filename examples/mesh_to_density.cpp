// Turns a mesh file, or a built-in shape such as shape:torus, into a band-limited density.
//
//     mesh_to_density INPUT OUTPUT.vdb [RESOLUTION]

#include <bandvox/bandlimit/surface_to_density.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/mesh_source.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

namespace {

std::unique_ptr<bandvox::BoundarySource> loadSolid(const std::string& input) {
    if (bandvox::isShape(input)) return bandvox::makeShapeBoundary(input);
    bandvox::MeshFile file = bandvox::readMesh(input);
    bandvox::ClosedMesh closed = bandvox::closeMesh(std::move(file.mesh));
    return std::make_unique<bandvox::MeshSource>(input, std::move(closed.mesh));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 4) {
        std::cerr << "usage: mesh_to_density INPUT OUTPUT.vdb [RESOLUTION]\n";
        return static_cast<int>(bandvox::ErrorKind::Usage);
    }
    try {
        const std::unique_ptr<bandvox::BoundarySource> solid = loadSolid(argv[1]);

        bandvox::DensityOptions options;
        if (argc == 4) options.resolution = std::stoi(argv[3]);
        const bandvox::DensityResult result = bandvox::surfaceToDensity(*solid, options);
        bandvox::writeVdb(argv[2], {result.grid});

        std::cout << "volume of the solid " << result.metadata.sourceVolume << ", of the density "
                  << result.metadata.gridVolume << ", error at most "
                  << result.metadata.closureError << '\n';
        return EXIT_SUCCESS;
    } catch (const bandvox::Error& error) {
        std::cerr << error.what() << '\n';
        return error.exitStatus();
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
