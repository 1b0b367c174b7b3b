#include "source/dicom_series.h"

#include "core/image_library.h"
#include "core/words.h"
#include "source/array_header.h"
#include "source/dicom_places.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

namespace bandvox {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFilesTogether = 8;
constexpr std::size_t kMostListed = 20;

std::unique_ptr<DicomFile> openDicom(const fs::path& path) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) failArray(path, "there is no such file");
    try {
        return imageLibrary().openDicom(path);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        failArray(path, error.what());
    }
}

// What one file says.
struct Member {
    fs::path path;
    DicomInfo info;
};

std::string storageInWords(const DicomInfo& info) {
    std::string text = std::to_string(info.width) + " x " + std::to_string(info.height);
    text += " pixels of " + std::to_string(info.bitsStored) + " of ";
    text += std::to_string(info.bitsAllocated) + " bits, ";
    text += info.isSigned ? "signed, " : "unsigned, ";
    return text + info.photometric;
}

bool isStoredAlike(const DicomInfo& a, const DicomInfo& b) {
    return a.width == b.width && a.height == b.height && a.bitsAllocated == b.bitsAllocated &&
           a.bitsStored == b.bitsStored && a.highBit == b.highBit && a.isSigned == b.isSigned &&
           a.photometric == b.photometric;
}

// Turns stored numbers of so many bits into values.
template <typename Stored>
void toValues(const std::vector<char>& bytes, const DicomInfo& info, const DicomFrame& frame,
              std::span<float> values) {
    const int shift = info.highBit + 1 - info.bitsStored;
    const std::uint64_t mask = (std::uint64_t(1) << info.bitsStored) - 1;
    const std::int64_t sign = std::int64_t(1) << (info.bitsStored - 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        Stored raw = 0;
        std::memcpy(&raw, &bytes[i * sizeof(Stored)], sizeof(Stored));
        auto number = static_cast<std::int64_t>((std::uint64_t(raw) >> shift) & mask);
        // Two's complement of so many bits.
        if (info.isSigned) number = (number ^ sign) - sign;
        values[i] = static_cast<float>(frame.slope * static_cast<double>(number) + frame.intercept);
    }
}

class DicomArray final : public ArraySource {
  public:
    DicomArray(ArrayInfo info, std::vector<DicomSlice> slices, DicomInfo storage)
        : ArraySource(std::move(info)), mSlices(std::move(slices)), mStorage(std::move(storage)) {}

    void readSlices(std::span<float> values) override {
        const auto perSlice = static_cast<std::size_t>(info().valuesPerSlice());
        while (!values.empty()) {
            const std::size_t count = std::min(values.size() / perSlice, kFilesTogether);
            if (mNext + count > mSlices.size()) {
                failArray(info().name, "there are no more slices in it");
            }
            if (mSlices.front().frames > 1) {
                if (!mFrames) mFrames = openDicom(mSlices.front().file);
                for (std::size_t i = 0; i < count; ++i) {
                    readSlice(*mFrames, mSlices[mNext + i], values.subspan(i * perSlice, perSlice));
                }
            } else {
                parallelFor(static_cast<std::int64_t>(count), [&](std::int64_t i) {
                    const auto at = static_cast<std::size_t>(i);
                    const auto file = openDicom(mSlices[mNext + at].file);
                    readSlice(*file, mSlices[mNext + at], values.subspan(at * perSlice, perSlice));
                });
            }
            mNext += count;
            values = values.subspan(count * perSlice);
        }
    }

  private:
    void readSlice(DicomFile& file, const DicomSlice& slice, std::span<float> values) const {
        std::vector<char> bytes;
        if (!isStoredAlike(file.info(), mStorage)) {
            failArray(slice.name(), "it has changed while it was read");
        }
        try {
            file.read(slice.frame, bytes);
        } catch (const Error& error) {
            failArray(slice.name(), error.what());
        }
        switch (mStorage.bitsAllocated) {
            case 8:
                return toValues<std::uint8_t>(bytes, mStorage, slice.place, values);
            case 16:
                return toValues<std::uint16_t>(bytes, mStorage, slice.place, values);
            default:
                return toValues<std::uint32_t>(bytes, mStorage, slice.place, values);
        }
    }

    std::vector<DicomSlice> mSlices;
    DicomInfo mStorage;
    std::unique_ptr<DicomFile> mFrames;
    std::size_t mNext = 0;  // slice
};

using SeriesMap = std::map<std::string, std::vector<Member>>;

// Reads what files say, and leaves those out that hold no images, as a DICOMDIR.
SeriesMap examineFiles(StackFiles& files) {
    SeriesMap series;
    std::vector<std::string> without;
    for (const fs::path& path : files.files) {
        // The directory of a disk is not of a series.
        if (path.filename() == "DICOMDIR") {
            without.push_back(path.filename().string());
            continue;
        }
        Member member{path, openDicom(path)->info()};
        if (member.info.frames.empty()) {
            without.push_back(path.filename().string());
            continue;
        }
        const std::string id = member.info.series;
        series[id].push_back(std::move(member));
    }
    if (!without.empty()) {
        files.notes.push_back(counted(without.size(), "DICOM file holds", "DICOM files hold") +
                              " no images and was left out: " + without.front() +
                              (without.size() > 1 ? ", ..." : ""));
    }
    if (series.empty()) failArray(files.name, "none of its DICOM files holds images");
    return series;
}

std::string listOfSeries(const SeriesMap& series) {
    std::string text;
    std::size_t number = 0;
    for (const auto& [id, members] : series) {
        if (number == kMostListed) return text + "; ...";
        const DicomInfo& info = members.front().info;
        text += (number == 0 ? "" : "; ") + std::to_string(number) + ": ";
        text += id + " (" + info.modality;
        if (!info.description.empty()) text += " '" + info.description + "'";
        text += ", " + counted(members.size(), "file", "files") + ")";
        ++number;
    }
    return text;
}

const std::vector<Member>& chooseSeries(const StackFiles& files, const SeriesMap& series,
                                        const std::string& asked) {
    if (asked.empty()) {
        if (series.size() == 1) return series.begin()->second;
        failArray(files.name, "it holds " + std::to_string(series.size()) +
                                  " series; expected one, or one that is chosen (--series): " +
                                  listOfSeries(series));
    }
    if (const auto found = series.find(asked); found != series.end()) return found->second;
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
    if (error == std::errc() && end == asked.data() + asked.size() && number < series.size()) {
        return std::next(series.begin(), static_cast<std::ptrdiff_t>(number))->second;
    }
    throw Error(ErrorKind::Usage, "the series '" + asked + "' of '" + files.name.string() +
                                      "' was asked for; expected a number or the UID of one of " +
                                      listOfSeries(series));
}

std::vector<DicomSlice> slicesOf(const std::vector<Member>& members) {
    std::vector<DicomSlice> slices;
    for (const Member& member : members) {
        const int frames = static_cast<int>(member.info.frames.size());
        if (frames > 1 && members.size() > 1) {
            failArray(member.path, "it holds " + std::to_string(frames) +
                                       " frames, and is one of " + std::to_string(members.size()) +
                                       " files; expected one file, or one frame in each");
        }
        for (int frame = 0; frame < frames; ++frame) {
            slices.push_back(
                {member.path, frame, frames, member.info.frames[static_cast<std::size_t>(frame)]});
        }
    }
    return slices;
}

// Frames of one file of which it is not said where they lie stay as they come.
bool isWithoutPlaces(const std::vector<DicomSlice>& slices) {
    return slices.front().frames > 1 &&
           std::none_of(slices.begin() + 1, slices.end(),
                        [](const DicomSlice& slice) { return slice.place.position.has_value(); });
}

// How large voxels of such frames are, as far as that is known.
void placeBySpacing(const DicomInfo& storage, ArrayInfo& info) {
    const auto& spacing = storage.frames.front().spacing;
    info.notes.emplace_back(
        "the file does not say where its frames lie; they are taken as they come");
    if (!spacing || storage.sliceStep <= 0) return;
    info.toWorld.preScale(openvdb::Vec3d((*spacing)[1], (*spacing)[0], storage.sliceStep));
    info.hasTransform = true;
    info.unit = "mm";
}

}  // namespace

std::unique_ptr<ArraySource> openDicomSeries(StackFiles files, const ArrayReadOptions& options) {
    if (!options.channel.empty()) {
        throw Error(ErrorKind::Usage, "a channel was asked for, and '" + files.name.string() +
                                          "' is of DICOM, one number to a pixel");
    }
    const SeriesMap series = examineFiles(files);
    const std::vector<Member>& members = chooseSeries(files, series, options.series);
    const DicomInfo storage = members.front().info;
    for (const Member& member : members) {
        if (isStoredAlike(member.info, storage)) continue;
        failArray(member.path, "it holds " + storageInWords(member.info) + ", and " +
                                   members.front().path.filename().string() + " " +
                                   storageInWords(storage) + "; expected all slices to be alike");
    }
    std::vector<DicomSlice> slices = slicesOf(members);
    ArrayInfo info;
    info.name = files.name.string();
    info.size = arraySize(files.name,
                          {double(storage.width), double(storage.height), double(slices.size())});
    info.axes = {0, 1, 2};
    info.valueType = (storage.isSigned ? "int" : "uint") + std::to_string(storage.bitsAllocated);
    info.notes = std::move(files.notes);
    info.toWorld = openvdb::Mat4d::identity();
    if (isWithoutPlaces(slices)) {
        placeBySpacing(storage, info);
    } else {
        info.toWorld = orderByPlace(slices, storage.sliceStep);
        info.hasTransform = true;
        info.unit = "mm";
        info.space = "left-posterior-superior";
        if (slices.size() == 1 && storage.sliceStep <= 0) {
            info.notes.emplace_back("nothing says how thick the only slice is; 1 mm was taken");
        }
    }
    if (storage.photometric == "MONOCHROME1") {
        info.notes.emplace_back(
            "these are images in which small values are shown bright (MONOCHROME1); values are "
            "taken as they are");
    }
    requireMemory(
        double(kFilesTogether) * double(info.valuesPerSlice()) * double(storage.bitsAllocated) / 4,
        "some slices of the series");
    return std::make_unique<DicomArray>(std::move(info), std::move(slices), storage);
}

}  // namespace bandvox
