// Points: .ply without faces, and tables in text.

#include "fuzz_input.h"

#include <bandvox/source/point_cloud.h>

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    static const fuzz::InputFile file(fuzz::extension(".csv"));
    const std::filesystem::path& path = file.write(data, size);
    (void)isPointCloudFile(path);
    fuzz::mayRefuse([&] {
        const PointCloud cloud = readPointCloud(path);
        if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size()) std::abort();
        if (!cloud.radii.empty() && cloud.radii.size() != cloud.points.size()) std::abort();
        for (const openvdb::Vec3d& point : cloud.points) {
            if (!point.isFinite()) std::abort();
        }
        for (const double radius : cloud.radii) {
            if (!(radius >= 0 && std::isfinite(radius))) std::abort();
        }
    });
    return 0;
}
