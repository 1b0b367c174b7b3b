#include "core/control_group.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

namespace fs = std::filesystem;

namespace {

// What a version of the interface calls its files.
struct MemoryFiles {
    std::vector<const char*> limits;
    const char* usage;
    const char* reclaimable;  // entry of memory.stat
};

const MemoryFiles& filesOfVersion1() {
    static const MemoryFiles files{
        {"memory.limit_in_bytes"}, "memory.usage_in_bytes", "total_inactive_file"};
    return files;
}

// Beyond memory.high a process is not killed, but slowed down until it hardly runs.
const MemoryFiles& filesOfVersion2() {
    static const MemoryFiles files{
        {"memory.max", "memory.high"}, "memory.current", "inactive_file"};
    return files;
}

// The number in a file of one number, or `otherwise` if there is none ("max", no such file).
std::int64_t numberIn(const fs::path& path, std::int64_t otherwise) {
    std::ifstream file(path);
    std::int64_t value = 0;
    const bool isNumber = file >> value && (file >> std::ws).eof() && value >= 0;
    return isNumber ? value : otherwise;
}

// An entry of a file of lines "name number"; 0 if it is not there.
std::int64_t entryIn(const fs::path& path, std::string_view name) {
    std::ifstream file(path);
    std::string key;
    std::int64_t value = 0;
    while (file >> key >> value) {
        if (key == name) return std::max<std::int64_t>(0, value);
    }
    return 0;
}

std::int64_t availableIn(const fs::path& group, const MemoryFiles& files) {
    std::int64_t limit = kUnlimitedMemory;
    for (const char* name : files.limits) {
        limit = std::min(limit, numberIn(group / name, kUnlimitedMemory));
    }
    if (limit == kUnlimitedMemory) return limit;
    // The cache of files counts as used, but what of it is inactive is given up before the limit
    // hurts.
    const std::int64_t usage = numberIn(group / files.usage, 0);
    const std::int64_t cache = entryIn(group / "memory.stat", files.reclaimable);
    return std::max<std::int64_t>(0, limit - std::max<std::int64_t>(0, usage - cache));
}

// The least of a group and of all that it is in. Inside a container the group's name may be that
// outside, where only the hierarchy's top is seen: what is not there limits nothing.
std::int64_t availableUpwards(const fs::path& hierarchy, const std::string& name,
                              const MemoryFiles& files) {
    std::int64_t available = kUnlimitedMemory;
    fs::path group = fs::path("/" + name).lexically_normal().relative_path();
    for (;;) {
        available = std::min(available, availableIn(hierarchy / group, files));
        if (group.empty()) return available;
        group = group.parent_path();
    }
}

bool isListed(std::string_view controllers, std::string_view wanted) {
    while (!controllers.empty()) {
        const std::size_t comma = std::min(controllers.find(','), controllers.size());
        if (controllers.substr(0, comma) == wanted) return true;
        controllers.remove_prefix(std::min(comma + 1, controllers.size()));
    }
    return false;
}

}  // namespace

std::int64_t availableInControlGroups(const fs::path& root) {
    const fs::path hierarchies = root / "sys/fs/cgroup";
    std::int64_t available = kUnlimitedMemory;
    std::ifstream memberships(root / "proc/self/cgroup");
    // Each line is "number:controllers:name"; version 2 has number 0 and names no controllers.
    for (std::string line; std::getline(memberships, line);) {
        const std::size_t first = line.find(':');
        const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string name = line.substr(second + 1);
        const auto consider = [&](const fs::path& hierarchy, const MemoryFiles& files) {
            available = std::min(available, availableUpwards(hierarchy, name, files));
        };
        if (isListed(controllers, "memory")) {
            consider(hierarchies / "memory", filesOfVersion1());
        } else if (line.starts_with("0::")) {
            consider(hierarchies, filesOfVersion2());
            // Where both versions are mounted.
            consider(hierarchies / "unified", filesOfVersion2());
        }
    }
    return available;
}

}  // namespace bandvox
