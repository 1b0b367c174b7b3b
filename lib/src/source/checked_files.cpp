#include "source/checked_files.h"

#include "core/letter_case.h"
#include "core/rehearsal.h"

#include <bandvox/core/progress.h>

#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace bandvox {

namespace fs = std::filesystem;

Assimp::IOStream* CheckedFiles::Open(const char* path, const char* mode) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        FileContents{path, {}}.fail("is not a regular file");
    }
    // All that an obj file refers to are its materials.
    const bool isMaterials = mIsObj && path != mMesh && fs::exists(status);
    if (isMaterials && mChecked.insert(path).second) {
        const FileContents file = readFile(path);
        checkMaterials(file);
        tryMaterials(file);
    }
    return DefaultIOSystem::Open(path, mode);
}

void tryMaterials(const FileContents& file) {
    constexpr std::int64_t kSeconds = 8, kBytesPerSecond = 1'000'000;
    constexpr std::int64_t kBytes = 600'000'000, kBytesPerByte = 200;
    const auto size = static_cast<std::int64_t>(file.bytes.size());
    const RehearsalLimits limits{kSeconds + size / kBytesPerSecond, kBytes + size * kBytesPerByte};
    const auto read = [&file] {
        std::string triangle = "mtllib ";
        triangle += file.path.string();
        triangle += "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        Assimp::Importer().ReadFileFromMemory(triangle.data(), triangle.size(), 0, "obj");
        return std::string();
    };
    const std::string wrong = rehearse(read, limits, silentProgress());
    if (!wrong.empty()) file.fail("is malformed: its importer " + wrong);
}

void checkMaterials(const FileContents& file) {
    constexpr std::array<std::string_view, 5> kTextures = {"map_", "bump", "disp", "norm", "refl"};
    // Whatever begins like "aniso" is taken for it.
    constexpr char kAnisotropy = 'a';
    // What ends a line for the importer; it takes a statement only where a line begins.
    constexpr std::string_view kLineEnds("\n\r\f\0", 4);
    const std::string_view text = file.bytes;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find_first_of(kLineEnds, begin), text.size());
        std::string_view line = text.substr(begin, end - begin);
        // Blanks before a statement mean nothing, except that they end the first line.
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        const bool isStatement = begin > 0 || line.size() == end;
        begin = end + 1;
        if (!isStatement) continue;
        if (line.starts_with("newmtl")) return;
        const std::string word = inLowerCase(std::string(line.substr(0, 4)));
        const bool isTexture =
            std::find(kTextures.begin(), kTextures.end(), word) != kTextures.end();
        if (isTexture || line.starts_with(kAnisotropy)) {
            file.fail("has \"" + std::string(line.substr(0, 40)) +
                      "\" before its first material; expected \"newmtl\" first");
        }
    }
}

}  // namespace bandvox
