#include "mesh/mesh_notes.h"

#include "mesh/mesh_checksum.h"

#include <bandvox/mesh/write_mesh.h>

#include <fstream>
#include <string_view>

namespace bandvox {

namespace {

// Notes stand at the start of a file; whatever its content is, no more of it is looked at.
constexpr std::size_t kLongestHead = 1 << 20;

constexpr std::string_view kGltfStart = R"(,"extras":{"notes":[)";
constexpr std::string_view kGltfAsset = R"({"asset":{"version":"2.0","generator":"Bandvox )";
constexpr std::size_t kGlbHeads = 20;        // before the text
constexpr std::size_t kLongestVersion = 40;  // after the generator's name

// Notes that follow each other in lines of their own.
std::vector<std::string> noteLines(std::string_view head, const std::string& mark) {
    std::vector<std::string> notes;
    for (std::size_t at = head.find(mark); at != std::string_view::npos;
         at = head.starts_with(mark) ? 0 : std::string_view::npos) {
        head.remove_prefix(at + mark.size());
        const std::size_t end = head.find('\n');
        if (end == std::string_view::npos) break;
        notes.emplace_back(head.substr(0, end));
        head.remove_prefix(end);
    }
    return notes;
}

// The texts of a list, as gltfNotes writes it.
std::vector<std::string> noteTexts(std::string_view list) {
    std::vector<std::string> notes;
    bool inside = false;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!inside) {
            if (list[i] == ']') break;
            if (list[i] == '"') notes.emplace_back();
            inside = list[i] == '"';
        } else if (list[i] == '"') {
            inside = false;
        } else {
            if (list[i] == '\\' && i + 1 < list.size()) ++i;
            notes.back() += list[i];
        }
    }
    return notes;
}

// All notes of a file, the checksum with them.
std::vector<std::string> allNotes(const std::filesystem::path& path) {
    if (!holdsNotes(path)) return {};
    const std::string head = headOfMeshFile(path);
    if (head.starts_with("ply\n")) {
        return noteLines(std::string_view(head).substr(0, head.find("\nend_header\n")), kPlyNote);
    }
    if (head.starts_with("# Bandvox ")) return noteLines(head, kObjNote);
    const std::size_t asset = head.find(kGltfAsset);
    const std::size_t start = asset > kGlbHeads ? std::string::npos : head.find(kGltfStart, asset);
    if (start == std::string::npos || start > asset + kGltfAsset.size() + kLongestVersion)
        return {};
    return noteTexts(std::string_view(head).substr(start + kGltfStart.size()));
}

}  // namespace

std::string headOfMeshFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string head(kLongestHead, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    return head;
}

std::string gltfNotes(const std::vector<std::string>& notes) {
    if (notes.empty()) return {};
    std::string text(kGltfStart);
    for (const std::string& note : notes) {
        if (&note != &notes.front()) text += ',';
        text += '"';
        for (const char c : note) {
            if (c == '"' || c == '\\') text += '\\';
            text += c;
        }
        text += '"';
    }
    return text + "]}";
}

std::vector<std::string> readMeshNotes(const std::filesystem::path& path) {
    std::vector<std::string> notes = allNotes(path);
    if (!notes.empty() && notes.back().starts_with(kChecksumMark)) notes.pop_back();
    return notes;
}

}  // namespace bandvox
