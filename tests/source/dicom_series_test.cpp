// DICOM series as arrays.

#include "source/dicom_writer.h"
#include "source/stack_images.h"

#include <bandvox/core/error.h>
#include <bandvox/source/array_source.h>

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::Vec3d;

// An image of 4 × 3 pixels.
struct TestSlice {
    std::string series = "1.2.3";
    std::string photometric = "MONOCHROME2";
    std::string transferSyntax = "1.2.840.10008.1.2.1";
    std::vector<double> position{0, 0, 0};  // empty: none
    std::vector<double> orientation{1, 0, 0, 0, 1, 0};
    std::vector<double> spacing{0.5, 0.25};  // of rows, of columns
    std::string thickness;
    std::string slope = "1", intercept = "0";
    int columns = 4, rows = 3, samples = 1;
    int allocated = 16, stored = 16, highBit = 15;
    bool isSigned = false;
    std::vector<int> values;  // as they are stored
    bool isPacked = false;

    std::string pixels() const {
        std::string bytes;
        for (const int value : values) {
            for (int i = 0; i < allocated / 8; ++i) {
                bytes += static_cast<char>(static_cast<unsigned>(value) >> 8 * i & 255);
            }
        }
        return bytes;
    }

    void describe(DicomWriter& to) const {
        to.text(0x00080060, "CS", "CT");
        to.text(0x0008103e, "LO", "a series");
        if (!thickness.empty()) to.text(0x00180050, "DS", thickness);
        to.text(0x0020000e, "UI", series);
        if (!position.empty()) to.text(0x00200032, "DS", dicomNumbers(position));
        if (!orientation.empty()) to.text(0x00200037, "DS", dicomNumbers(orientation));
    }

    void describePixels(DicomWriter& to, const std::string& frames = "") const {
        to.number(0x00280002, static_cast<std::uint16_t>(samples));
        to.text(0x00280004, "CS", photometric);
        if (!frames.empty()) to.text(0x00280008, "IS", frames);
        to.number(0x00280010, static_cast<std::uint16_t>(rows));
        to.number(0x00280011, static_cast<std::uint16_t>(columns));
        if (!spacing.empty()) to.text(0x00280030, "DS", dicomNumbers(spacing));
        to.number(0x00280100, static_cast<std::uint16_t>(allocated));
        to.number(0x00280101, static_cast<std::uint16_t>(stored));
        to.number(0x00280102, static_cast<std::uint16_t>(highBit));
        to.number(0x00280103, isSigned ? 1 : 0);
        to.text(0x00281052, "DS", intercept);
        to.text(0x00281053, "DS", slope);
    }

    std::string file() const {
        DicomWriter writer;
        describe(writer);
        describePixels(writer);
        if (isPacked) {
            writer.fragment(pixels());
        } else {
            writer.pixels(pixels());
        }
        return writer.file(transferSyntax);
    }
};

std::vector<int> valuesFrom(int first) {
    std::vector<int> values(12);
    for (int i = 0; i < 12; ++i) values[static_cast<std::size_t>(i)] = first + i;
    return values;
}

std::vector<float> readValues(const fs::path& path, const ArrayReadOptions& options = {}) {
    const auto source = openArray(path, options);
    std::vector<float> values(static_cast<std::size_t>(source->info().valuesPerSlice()) *
                              static_cast<std::size_t>(source->info().slices()));
    source->readSlices(values);
    return values;
}

class DicomSeries : public StackFolder {
  protected:
    void expectRefused(const std::vector<std::string>& said, const ArrayReadOptions& options = {},
                       ErrorKind kind = ErrorKind::Input) const {
        expectRefused(mFolder, said, options, kind);
    }

    static void expectRefused(const fs::path& path, const std::vector<std::string>& said,
                              const ArrayReadOptions& options = {},
                              ErrorKind kind = ErrorKind::Input) {
        try {
            readValues(path, options);
            ADD_FAILURE() << path << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind) << error.what();
            for (const std::string& words : said) {
                EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
                    << error.what() << "\n  does not say: " << words;
            }
        }
    }
};

TEST_F(DicomSeries, OrdersObliqueSlicesByTheirPlaces) {
    // Turned about two axes; the gantry is tilted, so that the step is not along the normal.
    const double c = std::cos(0.4), s = std::sin(0.4);
    const Vec3d row(c, s, 0), column(-s * 0.8, c * 0.8, 0.6);
    const Vec3d normal = row.cross(column);
    const Vec3d step = 2.5 * normal + 0.7 * column;
    const Vec3d first(-120.5, 33.25, 801.125);
    const std::vector<int> order{3, 0, 4, 1, 2};
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Vec3d place = first + double(order[i]) * step;
        TestSlice slice;
        slice.position = {place[0], place[1], place[2]};
        slice.orientation = {row[0], row[1], row[2], column[0], column[1], column[2]};
        slice.values = valuesFrom(100 * order[i]);
        // Without an extension, and in another order than their places.
        write("IM" + std::to_string(i), slice.file());
    }
    const auto source = openArray(mFolder);
    const ArrayInfo& info = source->info();
    EXPECT_EQ(info.size, Coord(4, 3, 5));
    EXPECT_EQ(info.valueType, "uint16");
    EXPECT_EQ(info.space, "left-posterior-superior");
    EXPECT_EQ(info.unit, "mm");
    EXPECT_TRUE(info.hasTransform);
    for (const Vec3d& at :
         {Vec3d(0, 0, 0), Vec3d(3, 0, 0), Vec3d(0, 2, 0), Vec3d(0, 0, 4), Vec3d(2, 1, 3)}) {
        const Vec3d expected = first + at[0] * 0.25 * row + at[1] * 0.5 * column + at[2] * step;
        EXPECT_LT((info.toWorld.transform(at) - expected).length(), 1e-6) << at;
    }
    const std::vector<float> values = readValues(mFolder);
    for (int z = 0; z < 5; ++z) {
        for (int i = 0; i < 12; ++i) {
            EXPECT_EQ(values[static_cast<std::size_t>(12 * z + i)], 100 * z + i);
        }
    }
}

TEST_F(DicomSeries, GivesValuesOfAllKindsOfPixels) {
    const auto read = [&](TestSlice slice, int third) {
        slice.values = valuesFrom(0);
        slice.values[2] = third;
        return readValues(write("one.dcm", slice.file()))[2];
    };
    EXPECT_EQ(read({.allocated = 8, .stored = 8, .highBit = 7}, 250), 250);
    EXPECT_EQ(read({}, 65535), 65535);
    EXPECT_EQ(read({.isSigned = true}, -1000), -1000);
    EXPECT_EQ(read({.allocated = 8, .stored = 8, .highBit = 7, .isSigned = true}, -100), -100);
    // 12 bits, and what else lies in the 16 is not theirs.
    EXPECT_EQ(read({.stored = 12, .highBit = 11}, 0xf123), 0x123);
    EXPECT_EQ(read({.stored = 12, .highBit = 11, .isSigned = true}, 0x0fff), -1);
    EXPECT_EQ(read({.stored = 12, .highBit = 15}, 0x1230), 0x123);
    EXPECT_EQ(read({.allocated = 32, .stored = 32, .highBit = 31, .isSigned = true}, -70000),
              -70000);
    // Hounsfield units, and steps that are no whole numbers.
    EXPECT_EQ(read({.intercept = "-1024"}, 24), -1000);
    EXPECT_FLOAT_EQ(read({.slope = "0.123456", .intercept = "-0.5"}, 1001),
                    static_cast<float>(0.123456 * 1001 - 0.5));
    EXPECT_EQ(read({.photometric = "MONOCHROME1"}, 7), 7);
    EXPECT_NE(openArray(mFolder / "one.dcm")->info().notes.back().find("MONOCHROME1"),
              std::string::npos);
    // The only slice is as thick as is said.
    TestSlice thick{.thickness = "1.5", .values = valuesFrom(0)};
    EXPECT_TRUE(openArray(write("thick.dcm", thick.file()))
                    ->info()
                    .toWorld.transform(Vec3d(1, 1, 1))
                    .eq(Vec3d(0.25, 0.5, 1.5), 1e-9));
}

TEST_F(DicomSeries, RescalesEachSliceByItsOwn) {
    for (int z = 0; z < 3; ++z) {
        TestSlice slice{.position = {0, 0, 2.0 * z}, .values = valuesFrom(10)};
        slice.slope = std::to_string(z + 1);
        slice.intercept = std::to_string(-z);
        write(std::to_string(z), slice.file());
    }
    const std::vector<float> values = readValues(mFolder);
    EXPECT_EQ(values[0], 10);
    EXPECT_EQ(values[12], 19);
    EXPECT_EQ(values[25], 31);
}

TEST_F(DicomSeries, ChoosesASeries) {
    for (int z = 0; z < 3; ++z) {
        write("a" + std::to_string(z),
              TestSlice{.position = {0, 0, double(z)}, .values = valuesFrom(z)}.file());
        write("b" + std::to_string(z),
              TestSlice{
                  .series = "1.2.9", .position = {0, 0, double(z)}, .values = valuesFrom(50 + z)}
                  .file());
    }
    DicomWriter report;
    report.text(0x00080060, "CS", "SR");
    write("report.dcm", report.file());
    write("DICOMDIR", report.file());
    expectRefused({"2 series", "0: 1.2.3 (CT 'a series', 3 files)", "1: 1.2.9", "--series"});
    EXPECT_EQ(readValues(mFolder, {.series = "0"})[0], 0);
    EXPECT_EQ(readValues(mFolder, {.series = "1"})[12], 51);
    EXPECT_EQ(readValues(mFolder, {.series = "1.2.9"})[12], 51);
    EXPECT_NE(openArray(mFolder, {.series = "1"})->info().notes.at(0).find("2 DICOM files hold no"),
              std::string::npos);
    expectRefused({"'2'", "1.2.9"}, {.series = "2"}, ErrorKind::Usage);
    expectRefused({"channel"}, {.channel = "R"}, ErrorKind::Usage);
}

TEST_F(DicomSeries, RefusesSlicesThatDoNotFit) {
    const auto put = [&](int z, TestSlice slice) {
        if (slice.position.size() == 3 && slice.position[2] == 0) slice.position[2] = 2.0 * z;
        if (slice.values.empty()) slice.values = valuesFrom(z);
        write("s" + std::to_string(z), slice.file());
    };
    const auto reset = [&] {
        for (int z = 0; z < 6; ++z) put(z, {});
    };
    reset();
    EXPECT_EQ(openArray(mFolder)->info().size, Coord(4, 3, 6));
    fs::remove(mFolder / "s3");
    expectRefused({"s4", "4 mm after", "s2", "2 mm", "1 slice is missing"});
    put(3, {.position = {0, 0, 6.5}});
    expectRefused({"s3", "2.5 mm after", "even steps"});
    put(3, {.position = {0, 0, 4}});
    expectRefused({"s3", "lies where", "s2", "(0, 0, 4)"});
    put(3, {.position = {1, 0, 6}});
    expectRefused({"s3", "(1, 0, 6)", "1 mm from (0, 0, 6)"});
    reset();
    put(2, {.orientation = {1, 0, 0, 0, 0.8, 0.6}});
    expectRefused({"s2", "1\\0\\0\\0\\0.8\\0.6", "s0", "1\\0\\0\\0\\1\\0"});
    reset();
    put(2, {.orientation = {1, 0, 0, 1, 0, 0}});
    expectRefused({"s2", "right angle"});
    reset();
    put(2, {.spacing = {0.5, 0.5}});
    expectRefused({"s2", "PixelSpacing is 0.5\\0.5", "0.5\\0.25"});
    reset();
    put(2, {.spacing = {}});
    expectRefused({"s2", "no PixelSpacing"});
    reset();
    put(2, {.position = {}});
    expectRefused({"s2", "no ImagePositionPatient"});
    reset();
    put(2, {.isSigned = true});
    expectRefused({"s2", "signed", "s0", "unsigned"});
    reset();
    put(2, {.columns = 3, .rows = 4});
    expectRefused({"s2", "3 x 4", "4 x 3"});
}

TEST_F(DicomSeries, RefusesWhatItCannotRead) {
    const auto refuse = [&](const TestSlice& slice, const std::vector<std::string>& said) {
        expectRefused(write("x.dcm", slice.file()), said);
    };
    const std::vector<int> values = valuesFrom(0);
    refuse({.transferSyntax = "1.2.840.10008.1.2.4.90", .values = values, .isPacked = true},
           {"x.dcm", "JPEG 2000", "not read"});
    refuse({.columns = 60000, .rows = 60000, .values = values},
           {"x.dcm", "60000 x 60000", "more than its"});
    refuse({.photometric = "RGB", .samples = 3, .values = values}, {"3 x RGB", "MONOCHROME2"});
    refuse({.allocated = 12, .stored = 12, .highBit = 11, .values = values}, {"12 bits"});
    refuse({.stored = 16, .highBit = 11, .values = values}, {"up to bit 11"});
    refuse({.slope = "many", .values = values}, {"RescaleSlope", "many"});
    expectRefused(write("no.dcm", "no DICOM"), {"no.dcm"});
    expectRefused(write("empty.dcm", ""), {"empty.dcm"});
    expectRefused(mFolder / "none.dcm", {"no such file"});
    const std::string whole = TestSlice{.values = values}.file();
    for (std::size_t length = 132; length < whole.size(); length += 17) {
        expectRefused(write("cut.dcm", whole.substr(0, length)), {"cut.dcm"});
    }
}

TEST_F(DicomSeries, UnpacksRuns) {
    // PackBits of the high bytes, then of the low ones (PS3.5, annex G): 12 pixels of 0x0105.
    std::string packed(64, '\0');
    packed[0] = 2;
    packed[4] = 64;
    packed[8] = 66;
    packed += std::string("\xf5\x01\xf5\x05", 4);
    DicomWriter writer;
    TestSlice slice{.transferSyntax = "1.2.840.10008.1.2.5"};
    slice.describe(writer);
    slice.describePixels(writer);
    writer.fragment(packed);
    EXPECT_EQ(readValues(write("rle.dcm", writer.file(slice.transferSyntax))),
              std::vector<float>(12, 0x105));
}

TEST_F(DicomSeries, ReadsFramesOfOneFile) {
    // Each with its place and its own scale, in another order.
    const std::vector<int> order{2, 0, 1};
    TestSlice slice{.position = {}, .orientation = {}, .spacing = {}};
    std::vector<DicomWriter> frames;
    for (const int z : order) {
        DicomWriter place, scale, frame;
        place.text(0x00200032, "DS", dicomNumbers({5, 6, 7 + 3.0 * z}));
        scale.text(0x00281052, "DS", std::to_string(-z));
        scale.text(0x00281053, "DS", "2");
        frame.sequence(0x00209113, {place});
        frame.sequence(0x00289145, {scale});
        frames.push_back(frame);
        const std::vector<int> values = valuesFrom(100 * z);
        slice.values.insert(slice.values.end(), values.begin(), values.end());
    }
    DicomWriter turn, measures, shared, writer;
    turn.text(0x00200037, "DS", dicomNumbers({0, 1, 0, 0, 0, 1}));
    measures.text(0x00280030, "DS", dicomNumbers({0.5, 0.25}));
    shared.sequence(0x00209116, {turn});
    shared.sequence(0x00289110, {measures});
    slice.describe(writer);
    slice.describePixels(writer, "3");
    writer.sequence(0x52009229, {shared});
    writer.sequence(0x52009230, frames);
    writer.pixels(slice.pixels());
    // The normal is +x, and the places differ along z only.
    expectRefused(write("flat.dcm", writer.file()), {"lies where", "frame"});

    frames.clear();
    for (const int z : order) {
        DicomWriter place, scale, frame;
        place.text(0x00200032, "DS", dicomNumbers({7 + 3.0 * z, 5, 6}));
        scale.text(0x00281052, "DS", std::to_string(-z));
        scale.text(0x00281053, "DS", "2");
        frame.sequence(0x00209113, {place});
        frame.sequence(0x00289145, {scale});
        frames.push_back(frame);
    }
    DicomWriter good;
    slice.describe(good);
    slice.describePixels(good, "3");
    good.sequence(0x52009229, {shared});
    good.sequence(0x52009230, frames);
    good.pixels(slice.pixels());
    const fs::path path = write("frames.dcm", good.file());
    const auto source = openArray(path);
    EXPECT_EQ(source->info().size, Coord(4, 3, 3));
    EXPECT_LT((source->info().toWorld.transform(Vec3d(2, 1, 2)) - Vec3d(13, 5.5, 6.5)).length(),
              1e-9);
    const std::vector<float> values = readValues(path);
    for (int z = 0; z < 3; ++z) EXPECT_EQ(values[static_cast<std::size_t>(12 * z)], 200 * z - z);
}

}  // namespace
}  // namespace bandvox
