// The checks of mesh files alone, which are quicker than the importer.

#include "fuzz_input.h"
#include "source/file_integrity.h"
#include "source/nesting_depth.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    static const std::string extension = fuzz::extension(".ply");
    const FileContents file{"input" + extension, {reinterpret_cast<const char*>(data), size}};
    std::vector<std::string> warnings;
    fuzz::mayRefuse([&] {
        if (extension == ".obj") checkObj(file, warnings);
        if (extension == ".off") checkOff(file, warnings);
        if (extension == ".ply") checkPly(file, warnings);
        if (extension == ".stl") checkStl(file);
        if (extension == ".glb") checkGlb(file);
        if (extension == ".glb" || extension == ".gltf") checkGltf(file);
        if (extension == ".dae") checkCollada(file);
        if (extension == ".fbx") requireShallow(file, fbxDepth(file.bytes));
    });
    return 0;
}
