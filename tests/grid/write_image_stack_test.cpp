// Grids as stacks of images, and back.

#include "source/stack_images.h"

#include <bandvox/core/error.h>
#include <bandvox/grid/array_box.h>
#include <bandvox/grid/array_to_grid.h>
#include <bandvox/grid/write_image_stack.h>
#include <bandvox/source/array_source.h>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::Vec3d;

// 21 × 13 × 19 voxels of which some are 0, and none is beyond `largest`.
openvdb::FloatGrid::Ptr makeStackGrid(int largest, float factor = 1) {
    auto grid = openvdb::FloatGrid::create(0.0F);
    auto to = grid->getAccessor();
    for (auto at = CoordBBox(-4, 2, -7, 16, 14, 11).begin(); at; ++at) {
        const int value =
            ((*at).x() * 7919 + (*at).y() * 10473 + (*at).z() * 131 + 100000) % (largest + 1);
        if (value % 3 != 0) to.setValue(*at, factor * static_cast<float>(value));
    }
    const CoordBBox box(-5, 2, -8, 16, 14, 11);
    setArrayBox(*grid, box);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->transform().preScale(Vec3d(1, 0.5, 4));
    return grid;
}

class WriteImageStack : public StackFolder {
  protected:
    static openvdb::FloatGrid::Ptr read(const fs::path& path) {
        const auto source = openArray(path);
        return arrayToGrid(*source);
    }

    static void expectSame(const fs::path& path, const openvdb::FloatGrid& grid) {
        SCOPED_TRACE(path.string());
        const auto found = read(path);
        const CoordBBox box = arrayBox(grid);
        ASSERT_EQ(arrayBox(*found), CoordBBox(Coord(0), box.dim().offsetBy(-1)));
        for (auto at = box.begin(); at; ++at) {
            ASSERT_EQ(found->tree().getValue(*at - box.min()), grid.tree().getValue(*at)) << *at;
        }
    }

    void writeStack(const std::string& name, const openvdb::FloatGrid& grid, VoxelType type,
                    bool compress = true) const {
        ImageStackOptions options;
        options.voxels.type = type;
        options.compress = compress;
        if (isImagePattern(mFolder / name)) {
            writeImageStack(mFolder / name, grid, options);
            return;
        }
        AtomicFile file(mFolder / name);
        writeImagePages(file, grid, options);
        file.commit();
    }

    static void expectRefused(const std::string& said, ErrorKind kind,
                              const std::function<void()>& act) {
        try {
            act();
            ADD_FAILURE() << "expected an error that says " << said;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
        }
    }
};

TEST_F(WriteImageStack, ComesBackBitForBit) {
    struct Case {
        const char* name;
        VoxelType type;
        int largest;
        float factor;
    };
    for (const Case& one :
         {Case{"a.###.png", VoxelType::UInt8, 255, 1},
          Case{"b%03d.png", VoxelType::UInt16, 65535, 1},
          Case{"c.###.tif", VoxelType::UInt8, 255, 1},
          Case{"d.###.tif", VoxelType::UInt16, 65535, 1},
          Case{"e.###.tif", VoxelType::Int16, 32767, -1},
          Case{"f.###.tif", VoxelType::Float, 4000, 0.1F},
          Case{"g.###.tiff", VoxelType::Double, 4000, 0.1F},
          Case{"h.###.exr", VoxelType::Half, 2048, 1},
          Case{"i.###.exr", VoxelType::Float, 4000, 0.1F}, Case{"j.tif", VoxelType::UInt8, 255, 1},
          Case{"k.tif", VoxelType::UInt16, 65535, 1},
          Case{"l.tif", VoxelType::Float, 4000, 0.1F}}) {
        const auto grid = makeStackGrid(one.largest, one.factor);
        writeStack(one.name, *grid, one.type);
        expectSame(mFolder / one.name, *grid);
        if (std::string(one.name).ends_with("png")) continue;
        writeStack(one.name, *grid, one.type, /*compress=*/false);
        expectSame(mFolder / one.name, *grid);
    }
    EXPECT_TRUE(fs::exists(mFolder / "b019.png"));
    EXPECT_FALSE(fs::exists(mFolder / "b020.png"));
}

TEST_F(WriteImageStack, TellsTiffFilesHowLargeVoxelsAre) {
    const auto grid = makeStackGrid(255);
    grid->insertMeta("bandvox_unit", openvdb::StringMetadata("mm"));
    for (const char* name : {"v.###.tif", "v.tif"}) {
        writeStack(name, *grid, VoxelType::UInt8);
        const auto info = openArray(mFolder / name)->info();
        EXPECT_EQ(info.unit, "mm");
        EXPECT_TRUE(info.toWorld.transform(Vec3d(1, 1, 1)).eq(Vec3d(0.5, 0.25, 2), 1e-6));
    }
    // Without a unit it is known all the same.
    grid->removeMeta("bandvox_unit");
    writeStack("v.tif", *grid, VoxelType::UInt8);
    const auto info = openArray(mFolder / "v.tif")->info();
    EXPECT_TRUE(info.hasTransform);
    EXPECT_EQ(info.unit, "");
    EXPECT_TRUE(info.toWorld.transform(Vec3d(1, 1, 1)).eq(Vec3d(0.5, 0.25, 2), 1e-6));
}

TEST_F(WriteImageStack, RefusesWhatImagesCannotHold) {
    const auto grid = makeStackGrid(255);
    expectRefused("uint8, uint16", ErrorKind::Usage,
                  [&] { writeStack("a.#.png", *grid, VoxelType::Float); });
    expectRefused("half, float", ErrorKind::Usage,
                  [&] { writeStack("a.#.exr", *grid, VoxelType::UInt8); });
    expectRefused("type half", ErrorKind::Usage,
                  [&] { writeStack("a.#.tif", *grid, VoxelType::Half); });
    expectRefused("number of a slice", ErrorKind::Usage,
                  [&] { writeStack("a.png", *grid, VoxelType::UInt8); });
    // A longer stack that is there already would be mixed with this one.
    write("a.20.png", "");
    expectRefused("a.20.png", ErrorKind::Runtime,
                  [&] { writeStack("a.#.png", *grid, VoxelType::UInt8); });
    EXPECT_FALSE(fs::exists(mFolder / "a.0.png"));
    fs::remove(mFolder / "a.20.png");
    expectRefused("no folder", ErrorKind::Runtime,
                  [&] { writeStack("none/a.#.png", *grid, VoxelType::UInt8); });
    EXPECT_TRUE(fs::is_empty(mFolder));
}

}  // namespace
}  // namespace bandvox
