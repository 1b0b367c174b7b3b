// Figure 5 of N. Nakamura et al.: "Fast Generation Method from Boundary Representation Model to
// Binary Voxel Data by Using GPU": the time to voxelize against the level, the power of two along
// the longest side.

#include "experiments.h"
#include "paper_shapes.h"
#include "triangle_voxels.h"

#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>

#include <openvdb/openvdb.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox::experiments {

namespace {

constexpr int kLowestLevel = 7, kHighestLevel = 9;
constexpr int kRounds = 3;

// A way to voxelize: it returns how many voxels are inside.
struct Method {
    std::string name;
    std::function<std::int64_t(const MeshSource&, int resolution)> run;
};

std::vector<Method> methods(std::string& device) {
    const auto onGpu = [&device](GpuMethod method) {
        return [&device, method](const MeshSource& mesh, int resolution) {
            const VoxelResult result = meshToVoxelsOnGpu(mesh, {.resolution = resolution}, method);
            device = result.device;
            return result.voxels;
        };
    };
    return {{"baseline",
             [](const MeshSource& mesh, int resolution) {
                 const openvdb::Vec3d size = mesh.bounds().extents();
                 const double longest = std::max({size.x(), size.y(), size.z()});
                 return TriangleVoxels(mesh.mesh(), longest / resolution).voxels();
             }},
            {"cpu",
             [](const MeshSource& mesh, int resolution) {
                 return meshToVoxels(mesh, {.resolution = resolution}).voxels;
             }},
            {"slices", onGpu(GpuMethod::Slices)},
            {"bits", onGpu(GpuMethod::Bits)}};
}

}  // namespace

void measureVoxelTimes(const Folder& folder) {
    openvdb::initialize();
    Table table = folder.table("voxel_times", "shape,triangles,level,method,seconds,voxels,device");
    std::string device;
    for (const MeshSource& mesh : {chair(), propeller()}) {
        for (int level = kLowestLevel; level <= kHighestLevel; ++level) {
            // All methods by turns, so that whatever else the machine does meets them alike.
            std::vector<Method> all = methods(device);
            std::vector<std::vector<double>> seconds(all.size());
            std::vector<std::int64_t> voxels(all.size());
            for (int round = 0; round < kRounds; ++round) {
                for (std::size_t i = 0; i < all.size(); ++i) {
                    const auto start = std::chrono::steady_clock::now();
                    voxels[i] = all[i].run(mesh, 1 << level);
                    const std::chrono::duration<double> taken =
                        std::chrono::steady_clock::now() - start;
                    seconds[i].push_back(taken.count());
                }
            }
            for (std::size_t i = 0; i < all.size(); ++i) {
                std::sort(seconds[i].begin(), seconds[i].end());
                const bool isGpu = all[i].name == "slices" || all[i].name == "bits";
                std::string on = isGpu ? device : "CPU";
                std::replace(on.begin(), on.end(), ',', ';');
                table.add(mesh.name(), mesh.elementCount(), level, all[i].name,
                          seconds[i][kRounds / 2], voxels[i], on);
            }
        }
    }
}

}  // namespace bandvox::experiments
