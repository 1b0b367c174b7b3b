#include "standard_streams.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/density_grid.h>

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <iterator>

namespace bandvox::app {
namespace {

// Named as in vdb_tool.
constexpr const char* kStandardInput = "stdin.vdb";
constexpr const char* kStandardOutputs[] = {"stdout.vdb", "stdout.npy", "stdout.nrrd"};

}  // namespace

bool isStandardInput(const std::string& name) {
    return name == kStandardInput;
}

openvdb::GridPtrVec readGrids(const std::string& name) {
    if (!isStandardInput(name)) return readVdb(name);
    if (isatty(STDIN_FILENO)) {
        throw Error(ErrorKind::Usage,
                    "stdin.vdb is the standard input, and that is a terminal; expected a file or "
                    "a pipe");
    }
    std::ios::sync_with_stdio(false);
    return readVdb(std::cin, "the standard input");
}

std::filesystem::path outputPath(const std::string& name) {
    if (isStandardInput(name)) {
        throw Error(ErrorKind::Usage,
                    "option --output is 'stdin.vdb', the standard input; expected a file, or "
                    "stdout.vdb for the standard output");
    }
    if (std::find(std::begin(kStandardOutputs), std::end(kStandardOutputs), name) ==
        std::end(kStandardOutputs)) {
        return name;
    }
    if (isatty(STDOUT_FILENO)) {
        throw Error(ErrorKind::Usage,
                    name +
                        " is the standard output, and that is a terminal; expected a file or "
                        "a pipe");
    }
    return "/dev/stdout";
}

}  // namespace bandvox::app
