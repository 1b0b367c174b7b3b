// Pictures: the sky of a render, and the textures of meshes.

#include "core/image_library.h"
#include "fuzz_input.h"
#include "source/read_texture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    static const std::string extension = fuzz::extension(".png");
    static const fuzz::InputFile file(extension);
    const std::filesystem::path& path = file.write(data, size);
    fuzz::mayRefuse([&] { imageLibrary().read(path); });
    fuzz::mayRefuse([&] { readTexture(path); });
    // What is inside of a .glb file.
    fuzz::mayRefuse([&] { readTexture(std::as_bytes(std::span(data, size)), extension.substr(1)); });
    return 0;
}
