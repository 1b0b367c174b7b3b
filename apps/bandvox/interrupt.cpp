#include "interrupt.h"

#include <atomic>
#include <csignal>

namespace bandvox::app {
namespace {

std::atomic<int> gSignal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

extern "C" void rememberSignal(int signal) {
    gSignal.store(signal, std::memory_order_relaxed);
}

}  // namespace

void installSignalHandlers() {
    struct sigaction action = {};
    action.sa_handler = rememberSignal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction inherited = {};
        sigaction(signal, nullptr, &inherited);
        if (inherited.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
}

int interruptSignal() {
    return gSignal.load(std::memory_order_relaxed);
}

}  // namespace bandvox::app
