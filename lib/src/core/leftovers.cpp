#include "core/leftovers.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>
#include <vector>

namespace bandvox {

namespace {

constexpr std::size_t kBootDigits = 8;

// Another one after each start of the machine; empty if that is not known.
std::string bootDigits() {
    std::ifstream file("/proc/sys/kernel/random/boot_id");
    std::string id;
    file >> id;
    return id.size() > kBootDigits ? id.substr(0, kBootDigits) : std::string();
}

bool isOfThisBoot(std::string_view name) {
    return name.starts_with(temporaryPrefix()) && temporaryPrefix() != ".bandvox-";
}

std::vector<std::string> candidatesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(folder.c_str()), ::closedir);
    if (!listing) return names;
    while (const dirent* entry = ::readdir(listing.get())) {
        if (isOfThisBoot(entry->d_name)) names.emplace_back(entry->d_name);
    }
    return names;
}

// A file that is being written is locked by whoever writes it, and the lock ends with the process.
void removeUnlessLocked(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    struct stat status = {};
    const bool isOwn = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
                       status.st_uid == ::geteuid();
    if (isOwn && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(descriptor);
}

}  // namespace

const std::string& temporaryPrefix() {
    static const std::string prefix = [] {
        const std::string boot = bootDigits();
        return boot.empty() ? std::string(".bandvox-") : ".bandvox-" + boot + "-";
    }();
    return prefix;
}

bool claimTemporary(int descriptor) noexcept {
    struct stat status = {};
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    // Where there are no locks nobody removes anything.
    return ::fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

void removeLeftovers(const std::filesystem::path& folder) {
    static std::mutex mutex;
    static std::set<std::filesystem::path> seen;
    {
        const std::scoped_lock lock(mutex);
        std::error_code ignored;
        if (!seen.insert(std::filesystem::absolute(folder, ignored)).second) return;
    }
    for (const std::string& name : candidatesIn(folder)) {
        removeUnlessLocked((folder / name).string());
    }
}

}  // namespace bandvox
