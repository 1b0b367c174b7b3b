#include "core/temporary_table.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstddef>

namespace bandvox {

namespace {

enum State { kFree, kFilling, kNoted };

// A handler of signals can neither allocate nor wait: all is here from the start.
struct Slot {
    std::atomic<int> state{kFree};
    std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

std::array<Slot, 16> gSlots;

}  // namespace

int noteTemporary(const std::string& path) noexcept {
    if (path.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < gSlots.size(); ++i) {
        int expected = kFree;
        if (!gSlots[i].state.compare_exchange_strong(expected, kFilling)) continue;
        gSlots[i].path[path.copy(gSlots[i].path.data(), path.size())] = '\0';
        gSlots[i].state.store(kNoted, std::memory_order_release);
        return static_cast<int>(i);
    }
    return -1;
}

void dropTemporary(int slot) noexcept {
    if (slot >= 0) gSlots[static_cast<std::size_t>(slot)].state.store(kFree);
}

void removeNotedTemporaries() noexcept {
    const int error = errno;
    for (const Slot& slot : gSlots) {
        if (slot.state.load(std::memory_order_acquire) == kNoted) ::unlink(slot.path.data());
    }
    errno = error;
}

}  // namespace bandvox
