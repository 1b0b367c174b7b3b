#include "source/cad_integrity.h"
#include "source/cad_library.h"
#include "source/cad_to_patches.h"
#include "source/read_patches.h"

#include <bandvox/core/error.h>

#include <string>
#include <utility>

namespace bandvox {
PatchModel readCadPatches(const std::filesystem::path& path, Progress& progress) {
    const FileContents file{path, {}};
    requireSoundCadFile(readFile(path));
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
