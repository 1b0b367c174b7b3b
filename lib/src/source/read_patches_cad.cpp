#include "core/letter_case.h"
#include "source/cad_library.h"
#include "source/cad_to_patches.h"
#include "source/read_patches.h"

#include <bandvox/core/error.h>

#include <sstream>
#include <string>
#include <string_view>

namespace bandvox {
namespace {

// Open CASCADE takes files that were cut short for good, without what is missing.
void requireWholeFile(const FileContents& file) {
    const std::string& bytes = file.bytes;
    const std::string extension = lowerExtension(file.path);
    const auto head = std::string_view(bytes).substr(0, 4096);
    if (bytes.empty()) file.fail("is empty; expected a part");
    if (extension == ".step" || extension == ".stp") {
        if (head.find("ISO-10303-21") == std::string_view::npos) {
            file.fail("does not begin with ISO-10303-21; expected a STEP file");
        }
        if (bytes.rfind("END-ISO-10303-21") == std::string::npos) {
            file.fail("ends before END-ISO-10303-21; expected the rest of a STEP file");
        }
    } else if (extension == ".brep") {
        if (head.find("CASCADE Topology V") == std::string_view::npos) {
            file.fail("does not begin with CASCADE Topology; expected a BREP file as text");
        }
        // Each shape ends with a star; after the last one comes which of them is the whole. Without
        // that Open CASCADE may never come to an end.
        const auto star = bytes.rfind('*');
        std::istringstream rest(star == std::string::npos ? "" : bytes.substr(star + 1));
        std::string shape, location;
        rest >> shape >> location;
        const bool isShape = shape.size() > 1 && (shape[0] == '+' || shape[0] == '-');
        if (!isShape || location.empty()) {
            file.fail("ends before the shape that it is about; expected the rest of a BREP file");
        }
    } else {
        // Column 73 has the section's letter: Start, or Compressed or Binary, which are rare.
        constexpr std::size_t kLetter = 72;
        if (bytes.size() <= kLetter || bytes[kLetter] != 'S') {
            file.fail("has no S in column 73 of its first line; expected an IGES file as text");
        }
        const auto end = bytes.find_last_not_of(" \t\r\n");
        const auto line = bytes.rfind('\n', end) + 1;
        if (end < line + kLetter || bytes[line + kLetter] != 'T') {
            file.fail(
                "ends before the line with T in column 73; expected the rest of an IGES file");
        }
    }
}

}  // namespace

PatchModel readCadPatches(const std::filesystem::path& path, Progress& progress) {
    const FileContents file{path, {}};
    requireWholeFile(readFile(path));
    try {
        CadShape shape = cadLibrary().read(path, [&] { progress.throwIfInterrupted(); });
        for (std::string& name : shape.objects) {
            if (name.empty()) name = path.stem().string();
        }
        return patchesOf(std::move(shape));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        file.fail(error.what());
    }
}

}  // namespace bandvox
