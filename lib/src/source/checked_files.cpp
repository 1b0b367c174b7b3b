#include "source/checked_files.h"

#include <algorithm>
#include <array>
#include <cctype>
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
    if (mIsObj && path != mMesh && fs::exists(status)) checkMaterials(readFile(path));
    return DefaultIOSystem::Open(path, mode);
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
        const std::string_view line = text.substr(begin, end - begin);
        if (line.starts_with("newmtl")) return;
        std::string word(line.substr(0, 4));
        std::transform(word.begin(), word.end(), word.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const bool isTexture =
            std::find(kTextures.begin(), kTextures.end(), word) != kTextures.end();
        if (isTexture || line.starts_with(kAnisotropy)) {
            file.fail("has \"" + std::string(line.substr(0, 40)) +
                      "\" before its first material; expected \"newmtl\" first");
        }
        begin = end + 1;
    }
}

}  // namespace bandvox
