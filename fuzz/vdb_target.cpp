// .vdb files under the guard that watches what OpenVDB reads.

#include "fuzz_input.h"

#include <bandvox/grid/density_grid.h>

#include <openvdb/openvdb.h>

#include <sstream>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    fuzz::mayRefuse([&] {
        std::istringstream stream({reinterpret_cast<const char*>(data), size});
        for (const openvdb::GridBase::Ptr& grid : readVdb(stream, "input.vdb")) {
            // What is followed by all who use a grid.
            (void)grid->activeVoxelCount();
            (void)grid->evalActiveVoxelBoundingBox();
            (void)grid->memUsage();
        }
    });
    return 0;
}
