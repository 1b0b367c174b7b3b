// DICOM files, by DCMTK. PS3.3 of the standard says what the attributes mean.
#include "core/dicom_files.h"

#include "image_modules.h"

#include <bandvox/core/error.h>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dccodec.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcsequen.h>
#include <dcmtk/dcmdata/dcxfer.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace bandvox {

namespace {

// Longer values, pixels among them, stay in the file until they are needed.
constexpr Uint32 kLongestValue = 4096;
constexpr int kMostFrames = 1 << 20;

[[noreturn]] void failDicom(const std::string& why) {
    throw Error(ErrorKind::Input, why);
}

// Once, for all threads.
void registerCodecs() {
    static const bool done = [] {
        OFLog::configure(OFLogger::OFF_LOG_LEVEL);
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
        return true;
    }();
    static_cast<void>(done);
}

std::string textOf(DcmItem& item, const DcmTagKey& tag) {
    OFString text;
    if (item.findAndGetOFStringArray(tag, text).bad()) return {};
    const std::string all(text.data(), text.size());
    return all.substr(0, all.find_last_not_of(' ') + 1);
}

int numberOf(DcmItem& item, const DcmTagKey& tag, const char* name) {
    Uint16 number = 0;
    if (item.findAndGetUint16(tag, number).bad()) {
        failDicom(std::string("it has no ") + name + "; expected an image");
    }
    return number;
}

// So many numbers, or nothing if there is no such attribute.
template <std::size_t Count>
std::optional<std::array<double, Count>> numbersOf(DcmItem& item, const DcmTagKey& tag,
                                                   const char* name) {
    if (!item.tagExistsWithValue(tag)) return std::nullopt;
    std::array<double, Count> numbers{};
    Float64 one = 0;
    bool good = item.findAndGetFloat64(tag, one, Count).bad();  // no more than those
    for (std::size_t i = 0; i < Count && good; ++i) {
        good = item.findAndGetFloat64(tag, one, static_cast<unsigned long>(i)).good() &&
               std::abs(one) <= 1e30;
        numbers[i] = one;
    }
    if (!good) {
        failDicom(std::string("its ") + name + " is '" + textOf(item, tag).substr(0, 100) +
                  "'; expected " + std::to_string(Count) + (Count == 1 ? " number" : " numbers"));
    }
    return numbers;
}

// An item of a sequence, or the item itself if there is no such sequence.
DcmItem& within(DcmItem& item, const DcmTagKey& sequence) {
    DcmItem* inner = nullptr;
    return item.findAndGetSequenceItem(sequence, inner, 0).good() && inner ? *inner : item;
}

// Takes what an item says of a frame. Enhanced files say it in sequences, others at the top.
void readFrame(DcmItem& item, DicomFrame& frame) {
    DcmItem& place = within(item, DCM_PlanePositionSequence);
    if (auto position = numbersOf<3>(place, DCM_ImagePositionPatient, "ImagePositionPatient")) {
        frame.position = position;
    }
    DcmItem& turn = within(item, DCM_PlaneOrientationSequence);
    if (auto axes = numbersOf<6>(turn, DCM_ImageOrientationPatient, "ImageOrientationPatient")) {
        frame.orientation = axes;
    }
    DcmItem& measures = within(item, DCM_PixelMeasuresSequence);
    if (auto spacing = numbersOf<2>(measures, DCM_PixelSpacing, "PixelSpacing")) {
        frame.spacing = spacing;
    }
    DcmItem& values = within(item, DCM_PixelValueTransformationSequence);
    if (auto slope = numbersOf<1>(values, DCM_RescaleSlope, "RescaleSlope")) {
        frame.slope = (*slope)[0];
    }
    if (auto intercept = numbersOf<1>(values, DCM_RescaleIntercept, "RescaleIntercept")) {
        frame.intercept = (*intercept)[0];
    }
}

// How many bytes of pixels a byte of the file can become at most.
double mostPacked(const DcmXfer& transfer) {
    if (transfer.getStreamCompression() != ESC_none) return 1100;  // zlib: 258 bytes of 2 bits
    switch (transfer.getXfer()) {
        case EXS_RLELossless:
            return 128;
        case EXS_JPEGLSLossless:
        case EXS_JPEGLSLossy:
            return 65536;  // a row without change is a few bits
        default:
            // Of JPEG a block of 8 x 8 pixels of two bytes is one bit at least.
            return transfer.isEncapsulated() ? 1024 : 1;
    }
}

class DcmtkFile final : public DicomFile {
  public:
    explicit DcmtkFile(const std::filesystem::path& path) {
        registerCodecs();
        const OFCondition status =
            mFile.loadFile(path.c_str(), EXS_Unknown, EGL_noChange, kLongestValue);
        if (status.bad()) failDicom(std::string("it cannot be read (") + status.text() + ")");
        DcmItem& data = *mFile.getDataset();
        mInfo.series = textOf(data, DCM_SeriesInstanceUID);
        mInfo.description = textOf(data, DCM_SeriesDescription);
        mInfo.modality = textOf(data, DCM_Modality);
        if (!data.tagExists(DCM_PixelData)) {
            if (data.tagExists(DCM_FloatPixelData) || data.tagExists(DCM_DoubleFloatPixelData)) {
                failDicom("its pixels are floats; expected whole numbers");
            }
            return;
        }
        readFormat(data);
        readFrames(data);
        requireReadable(path);
    }

    void read(int frame, std::vector<char>& values) override {
        DcmItem& data = *mFile.getDataset();
        DcmElement* element = nullptr;
        if (data.findAndGetElement(DCM_PixelData, element).bad()) failDicom("it has no pixels");
        auto* pixels = dynamic_cast<DcmPixelData*>(element);
        Uint32 size = 0;
        if (!pixels || pixels->getUncompressedFrameSize(&data, size).bad()) {
            failDicom("it has no pixels of a known size");
        }
        const std::size_t expected = frameBytes();
        values.resize(std::max<std::size_t>(expected, size + (size & 1U)));
        Uint32 fragment = 0;
        OFString color;
        const OFCondition status =
            pixels->getUncompressedFrame(&data, static_cast<Uint32>(frame), fragment, values.data(),
                                         static_cast<Uint32>(values.size()), color);
        if (status.bad()) {
            failDicom("its frame " + std::to_string(frame) + " cannot be read (" + status.text() +
                      ")");
        }
        values.resize(expected);
    }

  private:
    std::size_t frameBytes() const {
        return static_cast<std::size_t>(mInfo.width) * mInfo.height * mInfo.bitsAllocated / 8;
    }

    void readFormat(DcmItem& data) {
        mInfo.width = numberOf(data, DCM_Columns, "Columns");
        mInfo.height = numberOf(data, DCM_Rows, "Rows");
        mInfo.bitsAllocated = numberOf(data, DCM_BitsAllocated, "BitsAllocated");
        mInfo.bitsStored = numberOf(data, DCM_BitsStored, "BitsStored");
        mInfo.highBit = numberOf(data, DCM_HighBit, "HighBit");
        mInfo.isSigned = numberOf(data, DCM_PixelRepresentation, "PixelRepresentation") == 1;
        mInfo.photometric = textOf(data, DCM_PhotometricInterpretation);
        const int samples = numberOf(data, DCM_SamplesPerPixel, "SamplesPerPixel");
        if (samples != 1 || !mInfo.photometric.starts_with("MONOCHROME")) {
            failDicom("its pixels are " + std::to_string(samples) + " x " + mInfo.photometric +
                      "; expected one number each, MONOCHROME1 or MONOCHROME2");
        }
        const bool isWhole =
            mInfo.bitsAllocated == 8 || mInfo.bitsAllocated == 16 || mInfo.bitsAllocated == 32;
        if (!isWhole || mInfo.bitsStored < 1 || mInfo.bitsStored > mInfo.bitsAllocated ||
            mInfo.highBit >= mInfo.bitsAllocated || mInfo.highBit + 1 < mInfo.bitsStored) {
            failDicom("of " + std::to_string(mInfo.bitsAllocated) + " bits of a pixel it uses " +
                      std::to_string(mInfo.bitsStored) + " up to bit " +
                      std::to_string(mInfo.highBit) + "; expected some of 8, 16 or 32");
        }
        if (mInfo.width < 1 || mInfo.height < 1) failDicom("its images have no pixels");
        if (data.tagExistsWithValue(DCM_ModalityLUTSequence)) {
            failDicom("its values go through a table (ModalityLUTSequence), which is not read");
        }
    }

    void readFrames(DcmItem& data) {
        Sint32 count = 1;
        if (data.tagExistsWithValue(DCM_NumberOfFrames) &&
            data.findAndGetSint32(DCM_NumberOfFrames, count).bad()) {
            count = 0;
        }
        if (count < 1 || count > kMostFrames) {
            failDicom("its NumberOfFrames is '" + textOf(data, DCM_NumberOfFrames).substr(0, 20) +
                      "'; expected 1 to 2^20");
        }
        DicomFrame common;
        readFrame(data, common);
        readFrame(within(data, DCM_SharedFunctionalGroupsSequence), common);
        for (const auto& [tag, name] :
             {std::pair(DCM_SliceThickness, "SliceThickness"),
              std::pair(DCM_SpacingBetweenSlices, "SpacingBetweenSlices")}) {
            for (DcmItem* item : {&data, &within(within(data, DCM_SharedFunctionalGroupsSequence),
                                                 DCM_PixelMeasuresSequence)}) {
                if (const auto step = numbersOf<1>(*item, tag, name)) mInfo.sliceStep = (*step)[0];
            }
        }
        mInfo.frames.assign(static_cast<std::size_t>(count), common);
        DcmSequenceOfItems* each = nullptr;
        if (data.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, each).good() && each) {
            if (each->card() != mInfo.frames.size()) {
                failDicom("it describes " + std::to_string(each->card()) + " frames of " +
                          std::to_string(count) + "; expected all of them");
            }
            for (std::size_t i = 0; i < mInfo.frames.size(); ++i) {
                readFrame(*each->getItem(static_cast<unsigned long>(i)), mInfo.frames[i]);
            }
        } else if (count > 1) {
            // One place is that of the first frame alone.
            for (std::size_t i = 1; i < mInfo.frames.size(); ++i) mInfo.frames[i].position.reset();
        }
    }

    // Throws if the pixels are packed in a way that is not known, or are fewer than is said.
    void requireReadable(const std::filesystem::path& path) {
        const DcmXfer transfer(mFile.getDataset()->getOriginalXfer());
        std::error_code error;
        const auto length = static_cast<double>(std::filesystem::file_size(path, error));
        const double claimed =
            static_cast<double>(frameBytes()) * static_cast<double>(mInfo.frames.size());
        const bool isPacked = transfer.isEncapsulated();
        if (isPacked &&
            !DcmCodecList::canChangeCoding(transfer.getXfer(), EXS_LittleEndianExplicit)) {
            failDicom(std::string("its pixels are packed by ") + transfer.getXferName() +
                      ", which is not read; unpack it with another program first");
        }
        if (!error && claimed > length * mostPacked(transfer)) {
            failDicom("it says that it holds " + std::to_string(mInfo.frames.size()) +
                      " images of " + std::to_string(mInfo.width) + " x " +
                      std::to_string(mInfo.height) + " pixels, more than its " +
                      std::to_string(static_cast<long long>(length)) + " bytes can be");
        }
    }

    DcmFileFormat mFile;
};

}  // namespace

std::unique_ptr<DicomFile> openDicomFile(const std::filesystem::path& path) {
    return std::make_unique<DcmtkFile>(path);
}

}  // namespace bandvox
