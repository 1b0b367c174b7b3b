#include <bandvox/core/error.h>
#include <bandvox/source/array_source.h>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::Vec3d;

// Value (x, y, z) of the arrays of 5 × 3 × 4 in these tests.
int valueAt(int x, int y, int z) {
    return 100 * x + 10 * y + z - 57;
}

// The values as bytes, x or z the fastest.
template <typename Stored>
std::string valueBytes(bool zFastest = false, bool swaps = false) {
    std::string bytes;
    const auto add = [&](int x, int y, int z) {
        const auto value = static_cast<Stored>(valueAt(x, y, z));
        char raw[sizeof(Stored)];
        std::memcpy(raw, &value, sizeof value);
        std::string one(raw, sizeof raw);
        if (swaps) one.assign(one.rbegin(), one.rend());
        bytes += one;
    };
    for (int i = 0; i < 5 * 3 * 4; ++i) {
        if (zFastest) {
            add(i / 12, i / 4 % 3, i % 4);
        } else {
            add(i % 5, i / 5 % 3, i / 15);
        }
    }
    return bytes;
}

std::string packed(const std::string& bytes, bool gzip) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY);
    std::string out(bytes.size() + 1000, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

std::string npy(const std::string& dictionary, int version = 1) {
    std::string text = "\x93NUMPY";
    text += static_cast<char>(version);
    text += '\0';
    const auto length = static_cast<std::uint32_t>(dictionary.size());
    for (int i = 0; i < (version == 1 ? 2 : 4); ++i) {
        text += static_cast<char>(length >> 8 * i & 255);
    }
    return text + dictionary;
}

class ArrayFile : public testing::Test {
  protected:
    void SetUp() override {
        mFolder = fs::temp_directory_path() / ("bandvox-array-" + std::to_string(getpid()));
        fs::create_directories(mFolder);
    }
    void TearDown() override { fs::remove_all(mFolder); }

    fs::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(mFolder / name, std::ios::binary) << bytes;
        return mFolder / name;
    }

    // Reads all, so many slices at a time, and compares.
    void expectValues(const fs::path& path, int together = 2) const {
        SCOPED_TRACE(path.string());
        const auto source = openArray(path);
        const ArrayInfo& info = source->info();
        ASSERT_EQ(info.size, Coord(5, 3, 4));
        std::vector<float> values(static_cast<std::size_t>(info.valuesPerSlice()) * info.slices());
        std::size_t done = 0;
        while (done < values.size()) {
            const std::size_t some = std::min(
                values.size() - done, static_cast<std::size_t>(info.valuesPerSlice()) * together);
            source->readSlices({&values[done], some});
            done += some;
        }
        std::size_t i = 0;
        Coord at;
        for (at[info.axes[2]] = 0; at[info.axes[2]] < info.slices(); ++at[info.axes[2]]) {
            for (at[info.axes[1]] = 0; at[info.axes[1]] < info.size[info.axes[1]];
                 ++at[info.axes[1]]) {
                for (at[info.axes[0]] = 0; at[info.axes[0]] < info.size[info.axes[0]];
                     ++at[info.axes[0]], ++i) {
                    ASSERT_EQ(values[i], valueAt(at[0], at[1], at[2])) << at;
                }
            }
        }
        std::vector<float> more(info.valuesPerSlice());
        EXPECT_THROW(source->readSlices(more), Error) << "beyond the end";
    }

    void expectRefused(const fs::path& path, const std::string& said) const {
        try {
            const auto source = openArray(path);
            std::vector<float> values(60);
            source->readSlices(values);
            ADD_FAILURE() << path << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Input);
            EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
        }
    }

    fs::path mFolder;
};

TEST_F(ArrayFile, ReadsNumPyInEitherOrder) {
    expectValues(
        write("c.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (5, 3, 4), }\n") +
                           valueBytes<double>(true)));
    expectValues(
        write("f.npy", npy("{'descr': '<i2', 'fortran_order': True, 'shape': (5, 3, 4), }\n") +
                           valueBytes<std::int16_t>(false)));
    expectValues(
        write("big.npy", npy("{'descr': '>i4', 'fortran_order': False, 'shape': (5, 3, 4)}", 2) +
                             valueBytes<std::int32_t>(true, true)),
        1);
    expectValues(
        write("i8.npy",
              npy("{\"shape\": (5,3,4), \"fortran_order\": False, \"descr\": \"<i8\"}", 3) +
                  valueBytes<std::int64_t>(true)),
        4);
    const auto info = openArray(mFolder / "c.npy")->info();
    EXPECT_EQ(info.valueType, "float64");
    EXPECT_FALSE(info.hasTransform);
}

TEST_F(ArrayFile, ReadsNrrdInsideAndBeside) {
    const std::string head = "NRRD0004\n# a comment\ntype: short\ndimension: 3\nsizes: 5 3 4\n";
    const std::string raw = valueBytes<std::int16_t>();
    expectValues(write("raw.nrrd", head + "encoding: raw\nendian: little\n\n" + raw));
    expectValues(write("big.nrrd", head + "encoding: raw\nendian: big\n\n" +
                                       valueBytes<std::int16_t>(false, true)));
    expectValues(
        write("gzip.nrrd", head + "encoding: gzip\nendian: little\n\n" + packed(raw, true)));
    expectValues(write("joined.nrrd", head + "encoding: gzip\nendian: little\n\n" +
                                          packed(raw.substr(0, 50), true) +
                                          packed(raw.substr(50), true)));
    std::string text;
    for (int i = 0; i < 60; ++i) {
        text += std::to_string(valueAt(i % 5, i / 5 % 3, i / 15)) + (i % 7 == 0 ? "\n" : " ");
    }
    expectValues(write("text.nrrd", head + "encoding: ascii\n\n" + text));

    write("all.raw", "a line\nxyz" + raw);
    expectValues(write("beside.nhdr", head + "encoding: raw\nendian: little\nline skip: 1\nbyte "
                                             "skip: 3\ndata file: all.raw\n"));
    expectValues(write("end.nhdr",
                       head + "encoding: raw\nendian: little\nbyteskip: -1\ndatafile: all.raw\n"));
    for (int slice = 0; slice < 4; ++slice) {
        write("s0" + std::to_string(slice + 3) + ".raw", raw.substr(30 * slice, 30));
    }
    expectValues(
        write("many.nhdr", head + "encoding: raw\nendian: little\ndata file: s%02d.raw 3 6 1\n"));
    // Numbers whose count is more than an int holds.
    for (const char* pattern : {"s%d.raw 0 -2147483648 -1", "s%d.raw 0 2147483647 1",
                                "s%d.raw 2147483646 2147483647 1"}) {
        std::string header = head;
        header += "encoding: raw\nendian: little\ndata file: ";
        header += pattern;
        const auto path = write("far.nhdr", header + "\n");
        std::vector<float> values(60);
        EXPECT_THROW(openArray(path)->readSlices(values), Error) << pattern;
    }
    expectValues(write("list.nhdr", head +
                                        "encoding: raw\nendian: little\ndata file: LIST\ns03.raw\n"
                                        "s04.raw\ns05.raw\ns06.raw\n"));
}

TEST_F(ArrayFile, ReadsMetaImageInsideAndBeside) {
    const std::string head =
        "ObjectType = Image\nNDims = 3\nDimSize = 5 3 4\nElementType = MET_SHORT\n";
    const std::string raw = valueBytes<std::int16_t>();
    expectValues(write("local.mha", head + "ElementDataFile = LOCAL\n" + raw));
    expectValues(write("packed.mha", head + "CompressedData = True\nElementDataFile = LOCAL\n" +
                                         packed(raw, false)));
    expectValues(write("big.mha", head +
                                      "BinaryDataByteOrderMSB = True\nElementDataFile = LOCAL\n" +
                                      valueBytes<std::int16_t>(false, true)));
    write("values.raw", "header" + raw);
    expectValues(write("beside.mhd", head + "HeaderSize = -1\nElementDataFile = values.raw\n"));
    expectValues(write("six.mhd", head + "HeaderSize = 6\nElementDataFile = values.raw\n"));
}

TEST_F(ArrayFile, SaysWhereVoxelsLie) {
    const std::string raw = valueBytes<float>();
    const auto nrrd = openArray(
        write("oblique.nrrd",
              "NRRD0005\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: 5 "
              "3 4\nspace directions: (0,2,0) (-1.5,0,0) (0,0.5,3)\nspace origin: "
              "(10,-20,30)\nencoding: raw\nendian: little\n\n" +
                  raw));
    const auto& toWorld = nrrd->info().toWorld;
    EXPECT_EQ(toWorld.transform(Vec3d(0.0)), Vec3d(10, -20, 30));
    EXPECT_EQ(toWorld.transform(Vec3d(1, 2, 4)), Vec3d(10 - 3, -20 + 2 + 2, 30 + 12));
    EXPECT_TRUE(nrrd->info().hasTransform);
    EXPECT_EQ(nrrd->info().space, "left-posterior-superior");

    const auto meta = openArray(write(
        "oblique.mha",
        "NDims = 3\nDimSize = 5 3 4\nElementType = MET_FLOAT\nElementSpacing = 2 1.5 "
        "3\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 -20 30\nElementDataFile = LOCAL\n" +
            raw));
    EXPECT_EQ(meta->info().toWorld.transform(Vec3d(1, 2, 4)), Vec3d(10 - 3, -20 + 2, 30 + 12));
}

// Axes of NRRD each by itself: spacings of which some are not known, and ends.
TEST_F(ArrayFile, TakesTheEndsOfAxes) {
    const std::string raw = valueBytes<std::int16_t>();
    const auto infoOf = [&](const std::string& fields) {
        return openArray(write("axes.nrrd",
                               "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 3 4\nencoding: "
                               "raw\nendian: little\n" +
                                   fields + "\n" + raw))
            ->info();
    };
    const auto placeOf = [](const ArrayInfo& info, const Vec3d& index) {
        return info.toWorld.transform(index);
    };
    EXPECT_EQ(placeOf(infoOf("spacings: 2 nan 0.5\n"), Vec3d(1, 1, 1)), Vec3d(2, 1, 0.5));
    EXPECT_TRUE(infoOf("spacings: 2 NaN 0.5\n").hasTransform);
    EXPECT_FALSE(infoOf("spacings: nan nan nan\n").hasTransform);
    // Ends are those of cells, or the nodes themselves.
    const std::string ends = "axis mins: 10 20 30\naxis maxs: 15 26 32\n";
    EXPECT_EQ(placeOf(infoOf(ends), Vec3d(0.0)), Vec3d(10.5, 21, 30.25));
    EXPECT_EQ(placeOf(infoOf(ends), Vec3d(1, 1, 1)), Vec3d(11.5, 23, 30.75));
    const auto nodes =
        infoOf("axis mins: 10 20 30\naxis maxs: 14 26 33\ncenterings: node node node\n");
    EXPECT_EQ(placeOf(nodes, Vec3d(0.0)), Vec3d(10, 20, 30));
    EXPECT_EQ(placeOf(nodes, Vec3d(1, 1, 1)), Vec3d(11, 23, 31));
    // A spacing counts more than the other end.
    const auto both = infoOf("axis mins: 10 nan 30\nspacings: 2 4 nan\ncenters: node ??? cell\n");
    EXPECT_EQ(placeOf(both, Vec3d(0.0)), Vec3d(10, 0, 30));
    EXPECT_EQ(placeOf(both, Vec3d(1, 1, 1)), Vec3d(12, 4, 31));
    EXPECT_THROW(infoOf("spacings: 2 nan\n"), Error);
    EXPECT_THROW(infoOf("axis mins: 1 2 three\n"), Error);
    EXPECT_THROW(infoOf("axis mins: 1 2 3\naxis maxs: 1 3 4\n"), Error) << "no step along x";
}

TEST_F(ArrayFile, ItsSpaceIsThatOfTheWorld) {
    const std::string raw = valueBytes<std::int16_t>();
    const std::string meta = "NDims = 3\nDimSize = 5 3 4\nElementType = MET_SHORT\n";
    const auto spaceOf = [&](const std::string& orientation) {
        return openArray(write("o.mha", meta + orientation + "ElementDataFile = LOCAL\n" + raw))
            ->info()
            .space;
    };
    // Where the axes of the array come from says nothing of the world, which is always the same.
    EXPECT_EQ(spaceOf("AnatomicalOrientation = RAI\n"), "left-posterior-superior");
    EXPECT_EQ(spaceOf("AnatomicalOrientation = RAS\n"), "left-posterior-superior");
    EXPECT_EQ(spaceOf("AnatomicalOrientation = ???\n"), "");
    EXPECT_EQ(spaceOf(""), "");

    const auto nrrd = openArray(write("ras.nrrd",
                                      "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 3 4\nspace: "
                                      "RAS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace "
                                      "origin: (10,20,30)\nencoding: raw\n\n" +
                                          raw));
    EXPECT_EQ(nrrd->info().space, "right-anterior-superior");
    nrrd->turnTo("LPS");
    EXPECT_EQ(nrrd->info().space, "left-posterior-superior");
    EXPECT_EQ(nrrd->info().toWorld.transform(Vec3d(1, 1, 1)), Vec3d(-11, -22, 33));
    EXPECT_THROW(openArray(mFolder / "o.mha")->turnTo("RAS"), Error) << "it says no space";
}

TEST_F(ArrayFile, SaysWhatItDoesNotRead) {
    const std::string raw = valueBytes<std::int16_t>();
    const std::string head = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 3 4\nencoding: raw\n\n";
    EXPECT_TRUE(openArray(write("exact.nrrd", head + raw))->info().notes.empty());
    const auto notes = openArray(write("more.nrrd", head + raw + "1234567"))->info().notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes[0].starts_with("7 bytes")) << notes[0];
}

TEST_F(ArrayFile, RefusesWhatIsNone) {
    const std::string raw = valueBytes<std::int16_t>();
    const std::string good = "{'descr': '<i2', 'fortran_order': True, 'shape': (5, 3, 4), }";
    expectRefused(mFolder / "none.npy", "cannot be opened");
    expectRefused(mFolder, "without images");
    expectRefused(write("none.txt", "hello"), "expected .npy");
    expectRefused(write("short.npy", npy(good) + raw.substr(1)), "too early");
    expectRefused(write("text.npy", "hello, this is text"), "NUMPY");
    expectRefused(write("head.npy", npy(good).substr(0, 30)), "header");
    for (const auto& [dictionary, said] : std::vector<std::pair<std::string, std::string>>{
             {"{'descr': '<c8', 'fortran_order': True, 'shape': (5, 3, 4)}", "type"},
             {"{'descr': [('a', '<i2')], 'fortran_order': True, 'shape': (5, 3, 4)}", "type"},
             {"{'descr': '<i2', 'fortran_order': True, 'shape': (5, 3)}", "3 numbers"},
             {"{'descr': '<i2', 'fortran_order': True, 'shape': (5, 3, 0)}", "along an axis"},
             {"{'descr': '<i2', 'fortran_order': True, 'shape': (5, 3, 9e9)}", "along an axis"},
             {"{'descr': '<i2', 'fortran_order': True}", "shape"},
             {"{'fortran_order': True, 'shape': (5, 3, 4)}", "descr"}}) {
        expectRefused(write("bad.npy", npy(dictionary) + raw), said);
    }
    const std::string head = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 3 4\n";
    for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
             {"NRRX", "NRRD"},
             {"NRRD0004\ntype: short\ndimension: 2\nsizes: 5 3\n\n", "dimensions"},
             {"NRRD0004\ntype: block\ndimension: 3\nsizes: 5 3 4\nencoding: raw\n\n", "block"},
             {head + "encoding: hex\n\n", "hex"},
             {head + "encoding: raw\nnonsense\n\n", "nonsense"},
             {head + "encoding: raw\ndata file: none.raw\n", "none.raw"},
             {head + "encoding: raw\ndata file: s%x.raw 1 2 1\n", "pattern"},
             {head + "encoding: raw\ndata file: s%d%s.raw 1 2 1\n", "pattern"},
             {head + "encoding: gzip\nendian: little\n\n" + packed(raw, true).substr(0, 40), ""},
             {head + "encoding: gzip\nendian: little\n\nrubbish that is not packed", "damaged"},
             {head + "encoding: text\n\n1 2 three", "three"},
             {head + "encoding: raw\nspace directions: (1,0,0) (2,0,0) (0,0,1)\n\n" + raw,
              "directions"},
             {head + "encoding: raw\n\n" + raw.substr(2), "too early"}}) {
        expectRefused(write("bad.nrrd", text), said);
    }
    const std::string meta = "NDims = 3\nDimSize = 5 3 4\nElementType = MET_SHORT\n";
    for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
             {"", "ElementDataFile"},
             {"NDims = 3\nElementDataFile = LOCAL\n", "type"},
             {meta + "ElementNumberOfChannels = 3\nElementDataFile = LOCAL\n", "channels"},
             {meta + "ElementDataFile = none.raw\n", "none.raw"},
             {meta + "ElementDataFile = LIST\n", "no data files"},
             {meta + "ElementSpacing = 1 1\nElementDataFile = LOCAL\n", "ElementSpacing"},
             {meta + "ElementSpacing = 1 1 0\nElementDataFile = LOCAL\n", "directions"},
             {meta + "HeaderSize = -1\nElementDataFile = LOCAL\n", "too early"}}) {
        expectRefused(write("bad.mhd", text), said);
    }
}

}  // namespace
}  // namespace bandvox
