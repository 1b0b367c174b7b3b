#include "grid/byte_source.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace bandvox {

namespace {

constexpr std::streamoff kPartBytes = std::streamoff(1) << 20;

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& path, std::streamoff size)
    : ByteSource(size), mDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}

FileBytes::~FileBytes() {
    if (isOpen()) ::close(mDescriptor);
}

std::size_t FileBytes::read(std::streamoff place, std::span<char> to) const {
    std::size_t done = 0;
    while (done < to.size()) {
        const ssize_t count = ::pread(mDescriptor, to.data() + done, to.size() - done,
                                      place + static_cast<std::streamoff>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        done += static_cast<std::size_t>(count);
    }
    return done;
}

MemoryBytes::MemoryBytes(std::string bytes)
    : ByteSource(static_cast<std::streamoff>(bytes.size())), mBytes(std::move(bytes)) {}

std::size_t MemoryBytes::read(std::streamoff place, std::span<char> to) const {
    if (place < 0 || place >= size()) return 0;
    return mBytes.copy(to.data(), to.size(), static_cast<std::size_t>(place));
}

SourceBuffer::SourceBuffer(const ByteSource& source, std::streamoff begin, std::streamoff end)
    : mSource(source),
      mBegin(begin),
      mEnd(std::min(end, source.size())),
      mPart(static_cast<std::size_t>(std::clamp<std::streamoff>(mEnd - begin, 1, kPartBytes))),
      mPartEnd(begin) {}

SourceBuffer::int_type SourceBuffer::underflow() {
    const std::streamoff left = std::max<std::streamoff>(mEnd - mPartEnd, 0);
    const auto wanted = std::min(mPart.size(), static_cast<std::size_t>(left));
    const std::size_t count = mSource.read(mPartEnd, {mPart.data(), wanted});
    if (count == 0) return traits_type::eof();
    mPartEnd += static_cast<std::streamoff>(count);
    setg(mPart.data(), mPart.data(), mPart.data() + count);
    return traits_type::to_int_type(*gptr());
}

std::streamsize SourceBuffer::xsgetn(char* to, std::streamsize count) {
    std::streamsize done = 0;
    while (done < count) {
        if (gptr() == egptr() && underflow() == traits_type::eof()) break;
        const std::streamsize some = std::min<std::streamsize>(egptr() - gptr(), count - done);
        std::memcpy(to + done, gptr(), static_cast<std::size_t>(some));
        setg(eback(), gptr() + some, egptr());
        done += some;
    }
    return done;
}

std::streampos SourceBuffer::seekoff(std::streamoff offset, std::ios::seekdir from,
                                     std::ios::openmode /*which*/) {
    std::streamoff to = offset;
    if (from == std::ios::beg) to += mBegin;
    if (from == std::ios::cur) to += place();
    if (from == std::ios::end) to += mEnd;
    if (to < mBegin || to > mEnd) return {std::streamoff(-1)};
    if (to >= mPartEnd - (egptr() - eback()) && to <= mPartEnd) {
        setg(eback(), egptr() - (mPartEnd - to), egptr());
    } else {
        setg(nullptr, nullptr, nullptr);
        mPartEnd = to;
    }
    return {to - mBegin};
}

std::streampos SourceBuffer::seekpos(std::streampos place, std::ios::openmode which) {
    return seekoff(place, std::ios::beg, which);
}

}  // namespace bandvox
