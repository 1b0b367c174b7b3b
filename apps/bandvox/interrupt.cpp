#include "interrupt.h"

#include <bandvox/core/atomic_file.h>

#include <atomic>
#include <csignal>

namespace bandvox::app {
namespace {

std::atomic<int> gSignal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

extern "C" void handleSignal(int signal) {
    int none = 0;
    if (gSignal.compare_exchange_strong(none, signal)) return;
    // Whoever asks twice does not want to wait. The signal is held back until this returns.
    AtomicFile::removeTemporaries();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

}  // namespace

void installSignalHandlers() {
    struct sigaction action = {};
    action.sa_handler = handleSignal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction inherited = {};
        sigaction(signal, nullptr, &inherited);
        if (inherited.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
    // A file that may not grow any more is an error like that of a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
}

int interruptSignal() {
    return gSignal.load(std::memory_order_relaxed);
}

}  // namespace bandvox::app
