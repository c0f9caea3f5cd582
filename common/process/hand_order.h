// What device_daemon tells the emulator that it has started: an attempt begins, and its hand does the script
// anew, or it has ended, and the hand rests. It goes as a signal with a value, in order; whoever was not
// started to hear it would end.
//
// Telling is for any normal thread. Hearing: listen before the first thread, then one thread takes.
#pragma once

#include <signal.h>

#include <ctime>

namespace bonemill {

enum class HandOrder : int { kNone = 0, kBeginAnew = 1, kRest = 2 };

inline int handOrderSignal() noexcept {
    return SIGRTMIN;
}

inline void tellHand(pid_t hand, HandOrder order) noexcept {
    sigval value{};
    value.sival_int = int(order);
    sigqueue(hand, handOrderSignal(), value);
}

inline sigset_t handOrderSignals() noexcept {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, handOrderSignal());
    return signals;
}

// From now on orders wait for takeHandOrder(), in this thread and in those that it starts.
inline void listenToHandOrders() noexcept {
    const sigset_t signals = handOrderSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

// Returns the oldest order that waits. It does not wait itself.
inline HandOrder takeHandOrder() noexcept {
    const sigset_t signals = handOrderSignals();
    const timespec now{};
    siginfo_t told{};
    if (sigtimedwait(&signals, &told, &now) != handOrderSignal()) return HandOrder::kNone;
    const int order = told.si_value.sival_int;
    return order == int(HandOrder::kBeginAnew) || order == int(HandOrder::kRest) ? HandOrder(order)
                                                                                 : HandOrder::kNone;
}

}  // namespace bonemill
