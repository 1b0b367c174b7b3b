#include "voxelize/gl_context.h"
#include "voxelize/gl_objects.h"
#include "voxelize/gpu_work.h"
#include "voxelize/lattice_points.h"
#include "voxelize/voxel_meshes.h"

#include <bandvox/core/error.h>
#include <bandvox/core/parallel.h>
#include <bandvox/source/close_mesh.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/voxelize/mesh_to_voxels.h>
#include <bandvox/voxelize/mesh_to_voxels_on_gpu.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace bandvox {
namespace {

using openvdb::Coord;
using openvdb::Vec3d;

constexpr GpuMethod kMethods[]{GpuMethod::Bits, GpuMethod::Slices};
constexpr ScanAxis kAxes[]{ScanAxis::X, ScanAxis::Y, ScanAxis::Z};

// Many tiles, and passes where that is possible.
constexpr GpuLimits kSmall{.side = 16, .bufferBytes = 1 << 11, .patches = 50};

/// Skips where there is no OpenGL.
class MeshToVoxelsOnGpu : public testing::Test {
  protected:
    void SetUp() override {
        static const std::string failure = whyNot();
        if (!failure.empty()) GTEST_SKIP() << failure;
    }

    static std::string whyNot() {
        try {
            const GlContext context;
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
};

VoxelResult onGpu(const Mesh& mesh, const VoxelOptions& options, const GpuWork& work) {
    return meshToVoxelsOnGpu(MeshSource("a.obj", mesh), options, work, silentProgress());
}

VoxelResult onCpu(const Mesh& mesh, const VoxelOptions& options) {
    return meshToVoxels(MeshSource("a.obj", mesh), options);
}

ErrorKind kindOfFailure(const Mesh& mesh, const VoxelOptions& options, GpuMethod method,
                        Progress& progress = silentProgress()) {
    try {
        meshToVoxelsOnGpu(MeshSource("a.obj", mesh), options, method, progress);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "voxels came";
    return ErrorKind::Runtime;
}

TEST_F(MeshToVoxelsOnGpu, AgreesWithTheCpuAlongEveryAxis) {
    for (const auto& [name, mesh] : test::hardMeshes()) {
        const VoxelResult expected = onCpu(mesh, {.voxelSize = 1});
        for (const ScanAxis axis : kAxes) {
            for (const GpuMethod method : kMethods) {
                SCOPED_TRACE(name + ", axis " + std::to_string(static_cast<int>(axis)) +
                             ", method " + std::to_string(static_cast<int>(method)));
                test::expectSameVoxels(
                    expected, onGpu(mesh, {.voxelSize = 1, .axis = axis}, {.method = method}));
            }
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, AgreesWithTheCpuForSubSamples) {
    int compared = 0;
    for (const auto& [name, mesh] : test::hardMeshes()) {
        std::vector<VoxelOptions> all{{.voxelSize = 1, .fraction = true}};
        for (const int threshold : {1, 4, 8}) {
            all.push_back({.voxelSize = 1, .threshold = threshold});
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
            SCOPED_TRACE(name + ", options " + std::to_string(i));
            VoxelOptions options = all[i];
            VoxelResult expected;
            try {
                expected = onCpu(mesh, options);
            } catch (const Error&) {
                // Of what is thin nothing is left.
                EXPECT_EQ(kindOfFailure(mesh, options, kMethods[i % 2]), ErrorKind::Result);
                continue;
            }
            ++compared;
            options.axis = kAxes[i % 3];
            test::expectSameVoxels(expected, onGpu(mesh, options, {.method = kMethods[i % 2]}));
        }
    }
    EXPECT_GT(compared, 64);
}

TEST_F(MeshToVoxelsOnGpu, TilesAndPassesMakeNoDifference) {
    for (const auto& [name, mesh] : test::hardMeshes()) {
        for (const GpuMethod method : kMethods) {
            for (const bool fraction : {false, true}) {
                // Slices of many tiles are slow.
                if (method == GpuMethod::Slices && (fraction || mesh.points.size() > 1000))
                    continue;
                SCOPED_TRACE(name + ", method " + std::to_string(static_cast<int>(method)));
                const VoxelOptions options{.voxelSize = 1, .fraction = fraction};
                test::expectSameVoxels(onCpu(mesh, options),
                                       onGpu(mesh, options, {method, kSmall}));
            }
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, LargeTrianglesReachOverTiles) {
    const Mesh cube = test::turned(test::cube(Vec3d(-150), 300));
    const Mesh needle =
        test::turned(test::placed(test::cube(Vec3d(0.0), 1), Vec3d(900, 3, 2), Vec3d(0.0)));
    for (const Mesh& mesh : {cube, needle}) {
        const VoxelResult expected = onCpu(mesh, {.voxelSize = 1});
        for (const GpuLimits& limits :
             {GpuLimits{}, GpuLimits{.side = 128}, GpuLimits{.bufferBytes = 1 << 18}}) {
            test::expectSameVoxels(expected,
                                   onGpu(mesh, {.voxelSize = 1}, {GpuMethod::Bits, limits}));
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, AgreesAtTheLargestSize) {
    // Slanted bars along each axis, which take all 31 bits of a coordinate. The second one's
    // corners lie anywhere on the planes x = 2y and x = 2y + 5, which hold many samples: sums of so
    // many bits do not fit into doubles, so they cannot tell.
    const auto rounded = [](double x) { return std::round(x * kVoxel) / kVoxel; };
    Mesh first = test::cube(Vec3d(0.0), 1), second = first;
    for (Vec3d& p : first.points) {
        p = p.x() * Vec3d(16360, 11.3, 7.9) + Vec3d(0, 3 * p.y(), 4 * p.z());
    }
    for (Vec3d& p : second.points) {
        const double y = rounded(0.3 + 8170.7 * p.y() + 0.61 * p.z());
        p = Vec3d(2 * y + 5 * p.x(), y, rounded(0.3 + 0.17 * p.x() + 3.77 * p.z()));
    }
    for (const Mesh& bar : {first, second}) {
        for (int axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE(axis);
            Mesh mesh = bar;
            for (Vec3d& p : mesh.points) {
                const Vec3d q = p;
                for (int i = 0; i < 3; ++i) p[(axis + i) % 3] = q[i];
            }
            const VoxelResult expected = onCpu(mesh, {.voxelSize = 1});
            EXPECT_GT(expected.voxels, 140000);
            for (const ScanAxis scan : kAxes) {
                test::expectSameVoxels(expected, onGpu(mesh, {.voxelSize = 1, .axis = scan}, {}));
            }
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, AgreesWithTheFormulaOfATurnedCube) {
    // What is within this distance of the surface, in voxels, may round either way.
    constexpr double kBand = 1e-5;
    constexpr double kHalf = 13.37;
    const Mesh axes = test::turned({{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}, {}});
    const Mesh mesh = test::turned(test::cube(Vec3d(-kHalf), 2 * kHalf));
    for (const GpuMethod method : kMethods) {
        const VoxelResult result = onGpu(mesh, {.voxelSize = 1}, {.method = method});
        const auto accessor = result.grid->getConstAccessor();
        for (auto voxel = openvdb::CoordBBox(Coord(-25), Coord(25)).begin(); voxel; ++voxel) {
            double distance = -kHalf;
            for (const Vec3d& axis : axes.points) {
                distance = std::max(distance, std::abs(axis.dot((*voxel).asVec3d())) - kHalf);
            }
            if (std::abs(distance) < kBand) continue;
            ASSERT_EQ(accessor.getValue(*voxel) == 1, distance < 0) << *voxel;
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, SlicesUniteOverlappingShells) {
    Mesh mesh = test::sphere(Vec3d(-3.1, 0.2, 0), 7, 20, 30);
    test::append(mesh, test::sphere(Vec3d(4.2, 1, -0.4), 6, 20, 30));
    test::append(mesh, test::reversed(test::cube(Vec3d(12.5), 3)));
    const VoxelResult expected = onCpu(mesh, {.voxelSize = 1});
    EXPECT_EQ(expected.warnings.size(), 1u);
    for (const ScanAxis axis : kAxes) {
        test::expectSameVoxels(
            expected, onGpu(mesh, {.voxelSize = 1, .axis = axis}, {.method = GpuMethod::Slices}));
    }
}

TEST_F(MeshToVoxelsOnGpu, ACavityStaysEmpty) {
    Mesh mesh = test::cube(Vec3d(-8), 16);
    test::append(mesh, test::reversed(test::cube(Vec3d(-4), 8)));
    for (const GpuMethod method : kMethods) {
        EXPECT_EQ(onGpu(mesh, {.voxelSize = 1}, {.method = method}).voxels,
                  16 * 16 * 16 - 8 * 8 * 8);
    }
}

TEST_F(MeshToVoxelsOnGpu, RefusesAnOpenMesh) {
    for (const int missing : {0, 3}) {
        Mesh mesh = test::cube(Vec3d(0.1, 0.2, 0.3), 5);
        mesh.triangles.erase(mesh.triangles.begin() + missing);
        for (const GpuMethod method : kMethods) {
            EXPECT_EQ(kindOfFailure(mesh, {.voxelSize = 0.25}, method), ErrorKind::Input);
        }
    }
}

TEST_F(MeshToVoxelsOnGpu, NoSampleInsideIsAFailure) {
    for (const GpuMethod method : kMethods) {
        EXPECT_EQ(kindOfFailure(test::cube(Vec3d(0.2), 0.6), {.voxelSize = 1}, method),
                  ErrorKind::Result);
    }
}

class Interrupting final : public Progress {
  public:
    void advance(std::int64_t) override { mInterrupted = true; }
    bool interrupted() const override { return mInterrupted; }

  private:
    std::atomic<bool> mInterrupted{false};
};

TEST_F(MeshToVoxelsOnGpu, CanBeInterruptedAndCalledAgain) {
    const Mesh mesh = test::cube(Vec3d(0.0), 30);
    Interrupting progress;
    EXPECT_EQ(kindOfFailure(mesh, {.voxelSize = 1}, GpuMethod::Slices, progress),
              ErrorKind::Interrupted);
    EXPECT_EQ(kindOfFailure(mesh, {.voxelSize = 1}, GpuMethod::Bits, progress),
              ErrorKind::Interrupted);
    EXPECT_EQ(onGpu(mesh, {.voxelSize = 1}, {}).voxels, 27000);
}

TEST_F(MeshToVoxelsOnGpu, IsTheSameFromAnyThreadAndForAnyNumberOfThem) {
    const Mesh mesh = test::turned(test::torus(20, 8, 90, 40));
    const VoxelResult expected = onCpu(mesh, {.voxelSize = 1});
    std::vector<VoxelResult> results(3);
    std::vector<std::thread> threads;
    for (VoxelResult& result : results) {
        threads.emplace_back([&] { result = onGpu(mesh, {.voxelSize = 1}, {}); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const VoxelResult& result : results) test::expectSameVoxels(expected, result);
    const ThreadLimit limit(1);
    test::expectSameVoxels(expected, onGpu(mesh, {.voxelSize = 1}, {}));
}

TEST_F(MeshToVoxelsOnGpu, NamesTheDevice) {
    const Mesh mesh = test::cube(Vec3d(0.0), 3);
    const GlContext context;
    // It leaves the context that was current there.
    EXPECT_EQ(onGpu(mesh, {.voxelSize = 1}, {}).device, context.device());
    EXPECT_NO_THROW(checkGl("going on"));
    GlBuffer buffer;
    const std::uint32_t word = 7;
    std::uint32_t back = 0;
    buffer.allocate(sizeof(word), &word, GL_STATIC_DRAW);
    buffer.read(sizeof(back), &back);
    EXPECT_EQ(back, word);
    EXPECT_EQ(onCpu(mesh, {.voxelSize = 1}).device, "");
}

TEST_F(MeshToVoxelsOnGpu, SaysWhatOpenGlSays) {
    const GlContext context;
    const auto messageOf = [](const auto& act) {
        try {
            act();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string bad = messageOf([] { const GlProgram program("#version 430 core\nx", ""); });
    EXPECT_NE(bad.find("does not compile a shader: "), std::string::npos) << bad;
    glEnable(GL_INVALID_ENUM);
    const std::string wrong = messageOf([] { checkGl("trying"); });
    EXPECT_EQ(wrong, "OpenGL failed with GL_INVALID_ENUM while trying");
    EXPECT_EQ(messageOf([] { checkGl("trying"); }), "");
}

TEST_F(MeshToVoxelsOnGpu, AgreesWithTheCpuOnRealMeshes) {
    const char* folder = std::getenv("BANDVOX_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "BANDVOX_TEST_DATA is not set";
    for (const char* name : {"stanford-bunny.obj", "fandisk.obj"}) {
        const Mesh mesh = closeMesh(readMesh(std::filesystem::path(folder) / name).mesh).mesh;
        const VoxelOptions options{.resolution = 200, .fraction = true};
        test::expectSameVoxels(onCpu(mesh, options), onGpu(mesh, options, {}));
    }
}

// No OpenGL is needed to be refused.
TEST(MeshToVoxelsOnGpuLimits, RefusesOptionsOutOfRange) {
    const Mesh mesh = test::cube(Vec3d(0.0), 2);
    for (const VoxelOptions& options :
         {VoxelOptions{.resolution = 0}, VoxelOptions{.resolution = 1 << 14},
          VoxelOptions{.resolution = 1 << 13, .threshold = 1}, VoxelOptions{.threshold = 9},
          VoxelOptions{.threshold = -1}, VoxelOptions{.threshold = 1, .fraction = true},
          VoxelOptions{.voxelSize = -1}}) {
        EXPECT_EQ(kindOfFailure(mesh, options, GpuMethod::Bits), ErrorKind::Usage);
    }
}

TEST(MeshToVoxelsOnGpuLimits, LooksForAGpu) {
    EXPECT_FALSE(findGpu().description.empty());
}

}  // namespace
}  // namespace bandvox
