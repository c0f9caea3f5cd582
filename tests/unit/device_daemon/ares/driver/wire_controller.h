// A controller at the other end of the wire that does what a test tells it, in the test's own thread.
#pragma once

#include <cstring>
#include <functional>

#include "common/rt/clock.h"
#include "device_daemon/ares/wire/controller_session.h"

namespace bonemill::test {

inline wire::Describe testDescription() {
    wire::Describe d{};
    std::strcpy(d.name, "test device");
    d.max_force = 5;
    d.workspace_radius = 0.1;
    d.watchdog_us = wire::kLongestWatchdogUs;
    d.rate_hz = 1000;
    d.kind = 5;
    return d;
}

template <class Packets>
struct WireController {
    using State = typename Packets::State;

    explicit WireController(const wire::Describe& description) : link(description, {wire::kLoopback, 0}) {
        state.inputs = wire::kInputChainClosed | wire::kInputHomed;
    }

    // One period: takes what has come and sends the state.
    void period() {
        const int64_t now_ns = monotonicNowNs();
        link.poll(now_ns);
        link.session().step(faults, is_powered, now_ns);
        state.mode = link.session().newestCommand().mode;
        link.send(state, now_ns);
    }

    wire::ControllerLink<Packets> link;
    State state{};
    uint32_t faults = 0;
    bool is_powered = true;
};

// Lets both sides take turns until the condition holds; the limit ends a test that hangs.
inline bool takeTurns(const std::function<void()>& host, const std::function<void()>& controller,
                      const std::function<bool()>& condition) {
    for (int i = 0; i < 100000; ++i) {
        host();
        if (condition()) return true;
        controller();
    }
    return false;
}

}  // namespace bonemill::test
