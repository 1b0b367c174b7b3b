#include "grid/leaf_spool.h"

#include "core/leftovers.h"

#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>

#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBytes = LeafSpool::Leaf::SIZE * sizeof(float);

// As many pieces as the system takes at once.
constexpr std::size_t kTogether = 256;

// A file that never had a name, or where there are none, one that has lost it at once.
int openNameless(const fs::path& folder) {
#ifdef O_TMPFILE
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0) return descriptor;
#endif
    std::string name = (folder / (temporaryPrefix() + "XXXXXX")).string();
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(name.c_str());
    return named;
}

}  // namespace

LeafSpool::LeafSpool(fs::path target) : mTarget(std::move(target)) {
    const fs::path written = followLinks(mTarget);
    mDescriptor = openNameless(written.has_parent_path() ? written.parent_path() : fs::path("."));
    if (mDescriptor < 0) fail(std::strerror(errno));
}

LeafSpool::~LeafSpool() {
    ::close(mDescriptor);
}

void LeafSpool::fail(const std::string& why) const {
    throw Error(ErrorKind::Runtime,
                "cannot write " + mTarget.string() + ", in a temporary file beside it: " + why);
}

void LeafSpool::write(std::uint32_t first, std::span<const std::unique_ptr<Leaf>> leaves) {
    auto place = static_cast<off_t>(first) * static_cast<off_t>(kBytes);
    std::size_t inFirst = 0;  // bytes of the first node that are written already
    std::vector<iovec> pieces;
    while (!leaves.empty()) {
        pieces.clear();
        for (const auto& leaf : leaves.first(std::min(leaves.size(), kTogether))) {
            char* from = reinterpret_cast<char*>(leaf->buffer().data());
            pieces.push_back({from + inFirst, kBytes - inFirst});
            inFirst = 0;
        }
        const std::size_t begun = kBytes - pieces[0].iov_len;
        const ssize_t count =
            ::pwritev(mDescriptor, pieces.data(), static_cast<int>(pieces.size()), place);
        if (count < 0 && errno != EINTR) fail(std::strerror(errno));
        const std::size_t written = count < 0 ? 0 : static_cast<std::size_t>(count);
        place += static_cast<off_t>(written);
        leaves = leaves.subspan((begun + written) / kBytes);
        inFirst = (begun + written) % kBytes;
    }
}

void LeafSpool::read(std::uint32_t number, Leaf& leaf) const {
    char* to = reinterpret_cast<char*>(leaf.buffer().data());
    const off_t begin = static_cast<off_t>(number) * static_cast<off_t>(kBytes);
    for (std::size_t done = 0; done < kBytes;) {
        const ssize_t count =
            ::pread(mDescriptor, to + done, kBytes - done, begin + static_cast<off_t>(done));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(std::strerror(errno));
        if (count == 0) fail("it was cut short");
        done += static_cast<std::size_t>(count);
    }
}

}  // namespace bandvox
