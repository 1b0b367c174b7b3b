#include "source/file_integrity.h"

#include "source/little_endian.h"
#include "source/nesting_depth.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace bandvox {

void FileContents::fail(const std::string& what) const {
    std::string message = "\"" + path.string() + "\" " + what;
    // What is quoted from the file may have zeros in it, which would end the message.
    std::replace(message.begin(), message.end(), '\0', '?');
    throw Error(ErrorKind::Input, message);
}

FileContents readFile(const std::filesystem::path& path) {
    FileContents file{path, {}};
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) file.fail("is a folder; expected a file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) file.fail(std::string("cannot be opened: ") + std::strerror(errno));
    stream.seekg(0, std::ios::end);
    const std::streamoff size = stream.tellg();
    if (size >= 0) {
        file.bytes.resize(static_cast<std::size_t>(size));
        stream.seekg(0);
        stream.read(file.bytes.data(), size);
    } else {
        // What has no end to go to, a pipe, is read as it comes.
        stream.clear();
        file.bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    if (!stream) file.fail(std::string("cannot be read: ") + std::strerror(errno));
    return file;
}

void checkGlb(const FileContents& file) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    const std::string& bytes = file.bytes;
    if (bytes.size() < kHeader || !bytes.starts_with("glTF")) {
        file.fail("does not begin with the header of binary glTF");
    }
    const std::size_t length = littleEndian32(bytes, 8);
    if (length != bytes.size()) {
        file.fail("has " + std::to_string(bytes.size()) + " bytes; its header says " +
                  std::to_string(length));
    }
    for (std::size_t offset = kHeader; offset < length;) {
        if (offset + kChunkHeader > length ||
            littleEndian32(bytes, offset) > length - offset - kChunkHeader) {
            file.fail("has a chunk at byte " + std::to_string(offset) +
                      " that ends beyond the file; expected it to end within");
        }
        offset += kChunkHeader + littleEndian32(bytes, offset);
    }
}

MeshFileFacts checkMeshFile(const std::filesystem::path& path, std::string_view extension) {
    MeshFileFacts facts;
    const FileContents file = readFile(path);
    if (extension == ".obj") checkObj(file, facts.warnings);
    if (extension == ".off") checkOff(file, facts.warnings);
    if (extension == ".ply") checkPly(file, facts.warnings);
    if (extension == ".stl") checkStl(file);
    if (extension == ".glb") checkGlb(file);
    if (extension == ".glb" || extension == ".gltf") facts.triangles = checkGltf(file);
    if (extension == ".dae") checkCollada(file);
    if (extension == ".fbx") requireShallow(file, fbxDepth(file.bytes));
    return facts;
}

}  // namespace bandvox
