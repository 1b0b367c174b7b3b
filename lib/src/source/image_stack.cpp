#include "source/image_stack.h"

#include "core/image_library.h"
#include "core/words.h"
#include "source/array_header.h"
#include "source/channel_choice.h"
#include "source/image_calibration.h"
#include "source/tiff_pages.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace bandvox {

namespace {

namespace fs = std::filesystem;

// Files of at most this many slices are open, and in memory, at a time.
constexpr std::size_t kTogether = 8;

std::unique_ptr<SliceFile> openSlices(const fs::path& path, int threads = 1) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) failArray(path, "there is no such file");
    const auto pages = countTiffPages(path);
    std::unique_ptr<SliceFile> file;
    try {
        file = imageLibrary().openSlices(path, threads);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        failArray(path, error.what());
    }
    if (pages && *pages != file->info().pages) {
        failArray(path, "it is damaged: of its " + std::to_string(*pages) + " pages " +
                            std::to_string(file->info().pages) + " can be read");
    }
    return file;
}

std::string kindInWords(const SliceFileInfo& info) {
    std::string text = std::to_string(info.width) + " x " + std::to_string(info.height);
    text += " pixels of " + std::to_string(info.channels.size()) + " x " + info.type;
    if (info.bits > 0 && 8 * bytesOf(typeNamed(info.type)) != static_cast<std::size_t>(info.bits)) {
        text += " (" + std::to_string(info.bits) + " bits)";
    }
    return text;
}

void requireSame(const fs::path& path, const SliceFileInfo& info, const fs::path& firstPath,
                 const SliceFileInfo& first) {
    if (info.width == first.width && info.height == first.height && info.type == first.type &&
        info.bits == first.bits && info.channels == first.channels) {
        return;
    }
    failArray(path, "it holds " + kindInWords(info) + ", and " + firstPath.filename().string() +
                        " " + kindInWords(first) + "; expected all slices to be alike");
}

void requireOnePage(const fs::path& path, const SliceFileInfo& info) {
    if (info.pages == 1) return;
    failArray(path, "it has " + std::to_string(info.pages) +
                        " pages; expected one in each file of a stack");
}

// A header can be damaged, and ask for anything.
void requirePlausible(const fs::path& path, const SliceFileInfo& info) {
    arraySize(path, {double(info.width), double(info.height), double(info.pages)});
    std::error_code error;
    const auto length = static_cast<double>(fs::file_size(path, error));
    if (error || info.pageBytes <= length * info.mostPacked) return;
    failArray(path, "it says that it holds " + kindInWords(info) + ", more than its " +
                        std::to_string(static_cast<long long>(length)) + " bytes can be");
}

class ImageStack final : public ArraySource {
  public:
    ImageStack(ArrayInfo info, std::vector<fs::path> files, SliceFileInfo slice,
               ChannelChoice channels)
        : ArraySource(std::move(info)),
          mFiles(std::move(files)),
          mSlice(std::move(slice)),
          mChannels(std::move(channels)),
          mType(typeNamed(mSlice.type)) {}

    void readSlices(std::span<float> values) override {
        const auto perSlice = static_cast<std::size_t>(info().valuesPerSlice());
        while (!values.empty()) {
            const std::size_t slices = std::min(values.size() / perSlice, kTogether);
            if (mNext + slices > static_cast<std::size_t>(info().slices())) {
                failArray(info().name, "there are no more slices in it");
            }
            if (mFiles.size() == 1) {
                if (!mPages) mPages = openSlices(mFiles.front(), threadCount());
                for (std::size_t i = 0; i < slices; ++i) {
                    readPage(*mPages, mFiles.front(), static_cast<int>(mNext + i),
                             values.subspan(i * perSlice, perSlice));
                }
            } else {
                parallelFor(static_cast<std::int64_t>(slices), [&](std::int64_t i) {
                    const auto slice = static_cast<std::size_t>(i);
                    const fs::path& path = mFiles[mNext + slice];
                    const auto file = openSlices(path);
                    requireSame(path, file->info(), mFiles.front(), mSlice);
                    readPage(*file, path, 0, values.subspan(slice * perSlice, perSlice));
                });
            }
            mNext += slices;
            values = values.subspan(slices * perSlice);
        }
    }

  private:
    void readPage(SliceFile& file, const fs::path& path, int page, std::span<float> to) const {
        std::vector<char> bytes;
        try {
            file.read(page, mChannels.first(), mChannels.count(), bytes);
        } catch (const Error& error) {
            failArray(path, (mFiles.size() == 1 ? "of page " + std::to_string(page) + ", " : "") +
                                error.what());
        }
        constexpr bool kBigEndian = std::endian::native == std::endian::big;
        if (mChannels.count() == 1) {
            toFloats(bytes.data(), to, mType, kBigEndian);
            narrow(to);
            return;
        }
        std::vector<float> all(to.size() * static_cast<std::size_t>(mChannels.count()));
        toFloats(bytes.data(), all, mType, kBigEndian);
        mChannels.combine(all, to, fullAlpha(), path.string() + pageInWords(page), info().size.x());
    }

    std::string pageInWords(int page) const {
        return mFiles.size() == 1 ? ", page " + std::to_string(page) : std::string();
    }

    // Grey of 1 to 15 bits comes spread over all of 8 or 16.
    void narrow(std::span<float> values) const {
        const int wide = 8 * static_cast<int>(bytesOf(mType));
        if (mSlice.channels.size() != 1 || mSlice.bits >= wide ||
            (mType != ArrayType::UInt8 && mType != ArrayType::UInt16)) {
            return;
        }
        const double factor = (std::ldexp(1.0, mSlice.bits) - 1) / (std::ldexp(1.0, wide) - 1);
        for (float& value : values) value = static_cast<float>(std::nearbyint(value * factor));
    }

    float fullAlpha() const {
        switch (mType) {
            case ArrayType::UInt8:
                return std::numeric_limits<std::uint8_t>::max();
            case ArrayType::Int8:
                return std::numeric_limits<std::int8_t>::max();
            case ArrayType::UInt16:
                return std::numeric_limits<std::uint16_t>::max();
            case ArrayType::Int16:
                return std::numeric_limits<std::int16_t>::max();
            case ArrayType::UInt32:
                return static_cast<float>(std::numeric_limits<std::uint32_t>::max());
            case ArrayType::Int32:
                return static_cast<float>(std::numeric_limits<std::int32_t>::max());
            default:
                return 1;
        }
    }

    std::vector<fs::path> mFiles;
    SliceFileInfo mSlice;
    ChannelChoice mChannels;
    ArrayType mType;
    std::unique_ptr<SliceFile> mPages;
    std::size_t mNext = 0;  // slice
};

// Sets where voxels lie, as far as the first slice says that.
void calibrate(const fs::path& path, const SliceFileInfo& first, ArrayInfo& info) {
    const auto calibration = readCalibration(first);
    if (!calibration) return;
    if (calibration->channels > 1 || calibration->frames > 1) {
        failArray(path, "it holds " + std::to_string(calibration->channels) + " channels and " +
                            std::to_string(calibration->frames) +
                            " frames, one page each; expected one of both");
    }
    const bool isAlone = info.size.z() == first.pages;
    if (isAlone && calibration->images > first.pages) {
        failArray(path, "its description says that it holds " +
                            std::to_string(calibration->images) + " images, and it has " +
                            counted(first.pages, "page", "pages") +
                            "; expected as many. (More than 4 GB are written like that by ImageJ "
                            "itself, and not read: save them as a sequence.)");
    }
    if (!calibration->hasSpacing) return;
    info.toWorld.preScale(calibration->spacing);
    info.hasTransform = true;
    info.unit = calibration->unit;
}

}  // namespace

std::unique_ptr<ArraySource> openImageStack(StackFiles files, const ArrayReadOptions& options) {
    if (!options.series.empty()) {
        throw Error(ErrorKind::Usage, "a series was asked for, and '" + files.name.string() +
                                          "' is an image or a stack of them, not of DICOM");
    }
    const fs::path& firstPath = files.files.front();
    const SliceFileInfo first = openSlices(firstPath)->info();
    requirePlausible(firstPath, first);
    const bool isSequence = files.files.size() > 1;
    if (isSequence) requireOnePage(firstPath, first);
    // Before hours of work, not in their midst.
    for (std::size_t i = 1; i < files.files.size(); ++i) {
        const SliceFileInfo slice = openSlices(files.files[i])->info();
        requireSame(files.files[i], slice, firstPath, first);
        requireOnePage(files.files[i], slice);
        requirePlausible(files.files[i], slice);
    }
    ArrayInfo info;
    info.name = files.name.string();
    const int slices = isSequence ? static_cast<int>(files.files.size()) : first.pages;
    info.size = openvdb::Coord(first.width, first.height, slices);
    info.axes = {0, 1, 2};
    info.valueType = first.type;
    info.toWorld = openvdb::Mat4d::identity();
    info.notes = std::move(files.notes);
    calibrate(firstPath, first, info);
    ChannelChoice channels(info.name, first, options.channel);
    // Each slice is there as it is stored, and as floats where channels are several.
    const double together = isSequence ? double(kTogether) : 1;
    const double floats = channels.count() > 1 ? sizeof(float) : 0;
    requireMemory(together * (first.pageBytes + floats * double(info.valuesPerSlice()) *
                                                    double(first.channels.size())),
                  "some slices of the stack");
    return std::make_unique<ImageStack>(std::move(info), std::move(files.files), first,
                                        std::move(channels));
}

}  // namespace bandvox
