// Mesh files, as they are checked and then read by the importer; .mtl files beside an .obj file.

#include "fuzz_input.h"

#include <bandvox/core/progress.h>
#include <bandvox/source/read_mesh.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    static const std::string extension = fuzz::extension(".ply");
    static const fuzz::InputFile file(extension);
    fuzz::mayRefuse([&] {
        std::filesystem::path path = file.write(data, size);
        if (extension == ".mtl") {
            path.replace_extension(".obj");
            std::ofstream(path) << "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        }
        Progress silent;
        const MeshFile mesh = readMesh(path, silent);
        for (const openvdb::Vec3I& triangle : mesh.mesh.triangles) {
            for (int i = 0; i < 3; ++i) {
                if (triangle[i] >= mesh.mesh.points.size()) std::abort();
            }
        }
    });
    return 0;
}
