#include "vdb_input.h"

#include "command_run.h"

#include <bandvox/source/read_mesh.h>
#include <bandvox/source/shapes.h>

#include <filesystem>

namespace bandvox::app {

void requireVdb(const std::string& verb, const std::string& input) {
    if (!isShape(input) && extensionOf(input) == ".vdb") return;
    std::string message = "cannot ";
    message += verb + " '" + input + "': expected a .vdb file";
    if (isShape(input) || isMeshFile(input)) {
        message += "; convert it first: bandvox convert " + input + " -o " +
                   (isShape(input) ? input.substr(input.find(':') + 1)
                                   : std::filesystem::path(input).stem().string()) +
                   ".vdb";
    }
    throw Error(ErrorKind::Input, message);
}

}  // namespace bandvox::app
