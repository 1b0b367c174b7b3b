#include "input_files.h"

#include "command_run.h"
#include "config_file.h"
#include "frame_pattern.h"
#include "standard_streams.h"

#include <bandvox/source/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace bandvox::app {

namespace fs = std::filesystem;

namespace {

// Headers of arrays are short; what follows them may be gigabytes without a line's end.
constexpr std::size_t kLongestHeader = 1 << 20;

void addFile(std::vector<fs::path>& files, const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return;
    if (std::find(files.begin(), files.end(), path) == files.end()) files.push_back(path);
}

// Calls `visit(key, value)` for each line "key value" of a text file.
template <typename Visitor>
void forEachLine(const fs::path& path, const Visitor& visit) {
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line);) {
        const std::string text = trimmed(line);
        const std::size_t space = text.find_first_of(" \t");
        if (space != std::string::npos) visit(text.substr(0, space), trimmed(text.substr(space)));
    }
}

// Options of a texture stand before its name.
std::string lastWord(const std::string& text) {
    return text.substr(text.find_last_of(" \t") + 1);
}

void addMaterials(std::vector<fs::path>& files, const fs::path& obj) {
    const fs::path folder = obj.parent_path();
    std::vector<fs::path> libraries;
    forEachLine(obj, [&](const std::string& key, const std::string& value) {
        if (key == "mtllib") addFile(libraries, folder / value);
    });
    for (const fs::path& library : libraries) {
        addFile(files, library);
        forEachLine(library, [&](const std::string& key, const std::string& value) {
            if (!key.starts_with("map_")) return;
            addFile(files, folder / value);
            addFile(files, folder / lastWord(value));
        });
    }
}

// A name in an URI may have "%20" for a space.
std::string decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const auto isHex = [&](std::size_t at) {
            return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at])) != 0;
        };
        if (uri[i] == '%' && isHex(i + 1) && isHex(i + 2)) {
            text += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

void addGltfParts(std::vector<fs::path>& files, const fs::path& gltf) {
    std::ifstream stream(gltf, std::ios::binary);
    const auto json = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
    if (!json.is_object()) return;
    for (const char* list : {"buffers", "images"}) {
        const auto found = json.find(list);
        if (found == json.end() || !found->is_array()) continue;
        for (const auto& part : *found) {
            if (!part.is_object() || !part.contains("uri") || !part["uri"].is_string()) continue;
            const auto uri = part["uri"].get<std::string>();
            if (!uri.starts_with("data:")) addFile(files, gltf.parent_path() / decoded(uri));
        }
    }
}

// The files that lines of a header name, alone or after ':' or '=', or by a pattern as s%03d.raw.
void addArrayParts(std::vector<fs::path>& files, const fs::path& header) {
    std::ifstream stream(header, std::ios::binary);
    std::string text(kLongestHeader, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    for (const std::string_view line : split(text, '\n')) {
        const std::size_t mark = line.find_first_of(":=");
        const std::string name =
            trimmed(std::string(mark == std::string_view::npos ? line : line.substr(mark + 1)));
        if (name.empty()) continue;
        addFile(files, header.parent_path() / name);
        const std::string pattern =
            (header.parent_path() / name.substr(0, name.find(' '))).string();
        if (!hasFrame(pattern)) continue;
        for (const int number : framesOnDisk(pattern)) addFile(files, withFrame(pattern, number));
    }
}

void addFolder(std::vector<fs::path>& files, const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder, error)) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    for (const fs::path& path : found) addFile(files, path);
}

}  // namespace

std::vector<fs::path> filesOfInput(const std::string& input, bool wantsColors) {
    if (isShape(input) || isStandardInput(input)) return {};
    std::vector<fs::path> files;
    std::error_code ignored;
    if (fs::is_directory(input, ignored)) {
        addFolder(files, input);
        return files;
    }
    if (hasFrame(input)) {
        for (const int number : framesOnDisk(input)) addFile(files, withFrame(input, number));
        return files;
    }
    addFile(files, input);
    const std::string extension = extensionOf(input);
    if (extension == ".obj" && wantsColors) addMaterials(files, input);
    if (extension == ".gltf") addGltfParts(files, input);
    if (extension == ".nhdr" || extension == ".mhd") addArrayParts(files, input);
    return files;
}

}  // namespace bandvox::app
