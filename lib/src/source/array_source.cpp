#include "core/letter_case.h"
#include "core/words.h"
#include "source/array_header.h"
#include "source/dicom_series.h"
#include "source/image_stack.h"
#include "source/stack_files.h"

#include <bandvox/core/error.h>
#include <bandvox/source/array_source.h>
#include <bandvox/source/world_space.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace bandvox {

namespace {

namespace fs = std::filesystem;

// Of the bytes of an array's values, those in each of its files.
std::int64_t bytesInFile(const ArrayHeader& header) {
    const openvdb::Coord& size = header.info.size;
    return std::int64_t(size[0]) * size[1] * size[2] /
           static_cast<std::int64_t>(header.files.size()) *
           static_cast<std::int64_t>(bytesOf(header.type));
}

// The bytes of a header's files, one after another, without what is to be skipped; unpacked.
class ValueBytes {
  public:
    explicit ValueBytes(const ArrayHeader& header) : mHeader(header) {
        std::memset(&mZlib, 0, sizeof mZlib);
    }
    ~ValueBytes() {
        if (mUnpacks) inflateEnd(&mZlib);
    }
    ValueBytes(const ValueBytes&) = delete;
    ValueBytes& operator=(const ValueBytes&) = delete;

    // As many as there are, up to `count`.
    std::size_t read(char* to, std::size_t count) {
        std::size_t done = 0;
        while (done < count) {
            if (!mIsOpen && !openNext()) break;
            const std::size_t wanted = std::min(count - done, mLeft);
            const std::size_t some = wanted == 0 ? 0
                                     : mHeader.encoding == ArrayHeader::Encoding::Zlib
                                         ? unpack(to + done, wanted)
                                         : readPlain(to + done, wanted);
            done += some;
            if (mHeader.encoding != ArrayHeader::Encoding::Text) mLeft -= some;
            if (some == 0) close();
        }
        return done;
    }

    const fs::path& file() const { return mHeader.files[mFile == 0 ? 0 : mFile - 1]; }

  private:
    bool openNext() {
        if (mFile == mHeader.files.size()) return false;
        const fs::path& path = mHeader.files[mFile++];
        mStream = std::ifstream(path, std::ios::binary);
        std::error_code ignored;
        if (!mStream || fs::is_directory(path, ignored)) {
            failArray(path, "it cannot be opened for reading");
        }
        for (std::int64_t line = 0; line < mHeader.skipLines; ++line) {
            mStream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
        }
        skipBytes(path);
        if (!mStream) failArray(path, "it ends before its values");
        if (mHeader.encoding == ArrayHeader::Encoding::Zlib) beginUnpacking();
        mIsOpen = true;
        // Of several files each has its part, and what follows is none of the next one's. How
        // long a text is, nobody knows.
        const bool isCounted = mHeader.encoding != ArrayHeader::Encoding::Text;
        mLeft = isCounted ? static_cast<std::size_t>(bytesInFile(mHeader))
                          : std::numeric_limits<std::size_t>::max();
        return true;
    }

    void skipBytes(const fs::path& path) {
        if (mHeader.skipBytes >= 0) {
            mStream.seekg(mHeader.skipBytes, std::ios::cur);
            return;
        }
        // All but the values.
        const std::int64_t bytes = bytesInFile(mHeader);
        std::error_code error;
        const auto length = static_cast<std::int64_t>(fs::file_size(path, error));
        if (error || length < bytes) failArray(path, "it is shorter than its values are");
        mStream.seekg(length - bytes);
    }

    std::size_t readPlain(char* to, std::size_t count) {
        mStream.read(to, static_cast<std::streamsize>(count));
        return static_cast<std::size_t>(mStream.gcount());
    }

    void beginUnpacking() {
        constexpr int kZlibOrGzip = 15 + 32;
        if (mUnpacks) inflateEnd(&mZlib);
        std::memset(&mZlib, 0, sizeof mZlib);
        if (inflateInit2(&mZlib, kZlibOrGzip) != Z_OK) throw std::bad_alloc();
        mUnpacks = true;
    }

    // True if another gzip stream follows the one that ended, as where files were joined.
    bool beginMember() {
        constexpr Bytef kGzip = 0x1f;
        if (!fillPacked() || *mZlib.next_in != kGzip) return false;
        return inflateReset(&mZlib) == Z_OK;
    }

    // False at the end of the file.
    bool fillPacked() {
        if (mZlib.avail_in > 0) return true;
        mZlib.avail_in = static_cast<uInt>(readPlain(mPacked.data(), mPacked.size()));
        mZlib.next_in = reinterpret_cast<Bytef*>(mPacked.data());
        return mZlib.avail_in > 0;
    }

    std::size_t unpack(char* to, std::size_t count) {
        constexpr std::size_t kMost = std::size_t(1) << 30;
        mZlib.next_out = reinterpret_cast<Bytef*>(to);
        const auto room = static_cast<uInt>(std::min(count, kMost));
        mZlib.avail_out = room;
        while (mZlib.avail_out == room) {
            if (!fillPacked()) return 0;
            const int status = inflate(&mZlib, Z_NO_FLUSH);
            if (status == Z_STREAM_END && !beginMember()) break;
            if (status == Z_STREAM_END) continue;
            if (status != Z_OK && status != Z_BUF_ERROR) {
                failArray(file(), "its compressed values are damaged");
            }
        }
        return room - mZlib.avail_out;
    }

    void close() {
        // The next file's values would be taken for those that are missing in this one.
        if (mLeft > 0 && mFile < mHeader.files.size() &&
            mHeader.encoding != ArrayHeader::Encoding::Text) {
            failArray(file(), "it is shorter than its part of the values is");
        }
        mStream.close();
        mIsOpen = false;
        mZlib.avail_in = 0;
    }

    const ArrayHeader& mHeader;
    std::size_t mFile = 0;  // the next one
    bool mIsOpen = false;
    std::size_t mLeft = 0;  // bytes of values in the open file
    std::ifstream mStream;
    std::array<char, 1 << 16> mPacked{};
    z_stream mZlib;
    bool mUnpacks = false;
};

class FileArray final : public ArraySource {
  public:
    explicit FileArray(ArrayHeader header)
        : ArraySource(header.info), mHeader(std::move(header)), mBytes(mHeader) {}

    void readSlices(std::span<float> values) override {
        if (mHeader.encoding == ArrayHeader::Encoding::Text) {
            for (float& value : values) value = nextNumber();
            return;
        }
        constexpr std::size_t kTogether = 1 << 18;
        const std::size_t bytes = bytesOf(mHeader.type);
        mStored.resize(kTogether * bytes);
        while (!values.empty()) {
            const std::span<float> some = values.first(std::min(values.size(), kTogether));
            values = values.subspan(some.size());
            if (mBytes.read(mStored.data(), some.size() * bytes) != some.size() * bytes)
                failShort();
            toFloats(mStored.data(), some, mHeader.type, mHeader.bigEndian);
        }
    }

  private:
    [[noreturn]] void failShort() const {
        failArray(mHeader.info.name,
                  "it ends too early: there are fewer values than its header "
                  "says");
    }

    // The next number of a text.
    float nextNumber() {
        std::string word;
        char c = 0;
        const auto isBetween = [&c] {
            return c == ',' || std::isspace(static_cast<unsigned char>(c));
        };
        while (mBytes.read(&c, 1) == 1) {
            if (!isBetween()) {
                if (word.size() < 64) word += c;
            } else if (!word.empty()) {
                break;
            }
        }
        if (word.empty()) failShort();
        float number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size()) {
            failArray(mHeader.info.name, "it holds '" + word + "'; expected a number");
        }
        return number;
    }

    ArrayHeader mHeader;
    ValueBytes mBytes;
    std::vector<char> mStored;
};

// What no array can lie by. Voxels that are far longer than wide would take as many more to
// be made cubes.
void checkSides(const fs::path& path, const openvdb::Mat4d& toWorld) {
    constexpr double kSmallest = 1e-30, kLargest = 1e30, kMostElongated = 1e4;
    double shortest = kLargest, longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const openvdb::Vec3d along(toWorld(axis, 0), toWorld(axis, 1), toWorld(axis, 2));
        shortest = std::min(shortest, along.length());
        longest = std::max(longest, along.length());
    }
    if (toWorld.getMat3().det() == 0) {
        failArray(path, "its axes are not three different directions");
    }
    if (!(shortest >= kSmallest && longest < kLargest && longest <= kMostElongated * shortest)) {
        failArray(path, "its voxels have sides from " + inShort(shortest) + " to " +
                            inShort(longest) +
                            " world units; expected 1e-30 to 1e30, and none 10000 times as long "
                            "as another");
    }
}

// Of values that are stored as they are, how many bytes of the files are none of them.
void noteBytesBehind(ArrayHeader& header) {
    if (header.encoding != ArrayHeader::Encoding::Raw || header.skipLines > 0) return;
    if (header.skipBytes < 0) return;
    std::int64_t left = 0;
    for (const fs::path& file : header.files) {
        std::error_code error;
        const std::uintmax_t bytes = fs::file_size(file, error);
        if (error) return;
        left += std::max<std::int64_t>(
            0, static_cast<std::int64_t>(bytes) - header.skipBytes - bytesInFile(header));
    }
    if (left == 0) return;
    header.info.notes.push_back(std::to_string(left) +
                                " bytes follow the values that its header tells of, and are not "
                                "read");
}

}  // namespace

bool isArrayFile(const fs::path& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".npy" || extension == ".nrrd" || extension == ".nhdr" ||
           extension == ".mha" || extension == ".mhd";
}

bool isArrayInput(const fs::path& path) {
    return isArrayFile(path) || isStack(path);
}

void ArraySource::place(const std::optional<openvdb::Vec3d>& spacing,
                        const std::optional<openvdb::Vec3d>& origin) {
    openvdb::Mat4d& matrix = mInfo.toWorld;
    for (int axis = 0; spacing && axis < 3; ++axis) {
        if (!((*spacing)[axis] > 0 && std::isfinite((*spacing)[axis]))) {
            throw Error(ErrorKind::Usage, "the spacing of voxels is " + inShort((*spacing)[axis]) +
                                              " along an axis; expected it above 0");
        }
        const openvdb::Vec3d step(matrix(axis, 0), matrix(axis, 1), matrix(axis, 2));
        const double factor = (*spacing)[axis] / step.length();
        for (int column = 0; column < 3; ++column) matrix(axis, column) *= factor;
    }
    for (int column = 0; origin && column < 3; ++column) matrix(3, column) = (*origin)[column];
    mInfo.hasTransform = mInfo.hasTransform || spacing.has_value();
}

void ArraySource::turnTo(const std::string& space) {
    const auto turn = spaceToSpace(mInfo.space, space);
    if (!turn) {
        std::string message = mInfo.name + ": it cannot be brought to the space " + space + ": ";
        message += mInfo.space.empty() ? "it does not say where its axes point"
                                       : "its own is '" + mInfo.space + "'";
        throw Error(ErrorKind::Usage, message);
    }
    mInfo.toWorld *= *turn;
    mInfo.space = worldSpaceName(space);
}

std::unique_ptr<ArraySource> openArray(const fs::path& path, const ArrayReadOptions& options) {
    const std::string extension = lowerExtension(path);
    std::error_code ignored;
    if (!isArrayFile(path)) {
        StackFiles files = findStack(path);
        if (files.kind == StackFiles::Kind::Dicom)
            return openDicomSeries(std::move(files), options);
        return openImageStack(std::move(files), options);
    }
    if (!options.channel.empty() || !options.series.empty()) {
        throw Error(ErrorKind::Usage, "a channel or a series was asked for, and '" + path.string() +
                                          "' is neither an image nor of DICOM");
    }
    if (fs::is_directory(path, ignored)) failArray(path, "it is a folder; expected a file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) failArray(path, "it cannot be opened for reading");
    ArrayHeader header = extension == ".npy" ? readNpyHeader(path, stream)
                         : extension == ".nrrd" || extension == ".nhdr"
                             ? readNrrdHeader(path, stream)
                             : readMetaImageHeader(path, stream);
    header.info.name = path.string();
    header.info.valueType = nameOf(header.type);
    checkSides(path, header.info.toWorld);
    const openvdb::Coord& size = header.info.size;
    if (std::int64_t(size[0]) * size[1] * size[2] %
            static_cast<std::int64_t>(header.files.size()) !=
        0) {
        failArray(path, "its values are in " + std::to_string(header.files.size()) +
                            " files, which cannot hold as many each");
    }
    if (header.type == ArrayType::Int32 || header.type == ArrayType::UInt32 ||
        header.type == ArrayType::Int64 || header.type == ArrayType::UInt64) {
        header.info.notes.push_back(
            "values are kept as floats: whole numbers beyond 16777216 are rounded");
    }
    noteBytesBehind(header);
    return std::make_unique<FileArray>(std::move(header));
}

}  // namespace bandvox
