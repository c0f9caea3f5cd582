#include "device_daemon/ares/emulator/emulator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/log/log.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "common/rt/rt_guard.h"

namespace bonemill {
namespace {

constexpr int64_t kWatchPeriodNs = 50 * kNsPerMillisecond;
constexpr double kForEver = std::numeric_limits<double>::infinity();
// The host is told for so long that the controller leaves: until it has switched off, within these bounds.
constexpr int64_t kShortestGoodbyeNs = 100 * kNsPerMillisecond;
constexpr int64_t kLongestGoodbyeNs = 1000 * kNsPerMillisecond;

double endTimeOf(const Scenario& scenario, const EmulatorOptions& options) {
    const bool has_path = !scenario.phases.empty();
    const double path_end = has_path && !options.hold ? scenario.path.duration() : kForEver;
    return std::min(path_end, options.seconds.value_or(kForEver));
}

EmulatedControllerConfig controllerConfigOf(const EmulatorOptions& options, double rate_hz) {
    if (options.watchdog_ms * kMillisecond * rate_hz < 2) {
        throw UserError("a watchdog of " + std::to_string(options.watchdog_ms) +
                        " ms is shorter than two periods at " + std::to_string(rate_hz) +
                        " Hz: choose a longer --watchdog-ms or a higher --rate");
    }
    return {.rate_hz = rate_hz,
            .watchdog_us = uint32_t(std::lround(options.watchdog_ms * kPerMilli)),
            .is_homed = !options.is_unhomed,
            .faults = options.faults};
}

}  // namespace

std::string jsonLineOf(const EmulatorStatistics& s) {
    return nlohmann::ordered_json{{"ticks", s.ticks},
                                  {"missed_periods", s.missed_periods},
                                  {"wall_s", s.wall_time},
                                  {"scenario_s", s.scenario_time},
                                  {"max_tracking_mm", kPerMillimetre * s.max_tracking_error},
                                  {"stop_ticks", s.stop_ticks},
                                  {"packets_sent", s.packets_sent},
                                  {"packets_received", s.commands.accepted},
                                  {"packets_rejected", s.commands.rejected},
                                  {"packets_old", s.commands.old},
                                  {"packets_lost", s.commands.lost},
                                  {"packets_late", s.commands.late},
                                  {"watchdog_trips", s.watchdog_trips},
                                  {"final_phase", s.final_phase}}
        .dump();
}

Emulator::Emulator(const Scenario& scenario, const EmulatorOptions& options, const StopSignals& stop_signals)
    : scenario_(scenario),
      options_(options),
      stop_signals_(stop_signals),
      rate_hz_(options.rate_hz.value_or(scenario.rate_hz)),
      period_ns_(std::llround(kNsPerSecond / rate_hz_)),
      end_time_(endTimeOf(scenario, options)),
      socket_(wire::endpointOf(options.address, options.port)),
      from_host_(options.faults, options.seed, period_ns_),
      to_host_(options.faults, options.seed + 1, period_ns_),
      controller_(scenario, controllerConfigOf(options, rate_hz_), monotonicNowNs()) {
    socket_.admitOnly(wire::hereAt(options.host_port));
}

void Emulator::run() {
    RealtimeThread loop_thread(
        {.request = {.core = options_.core},
         .is_strict = options_.is_strict_realtime,
         .what = "the controller's loop"},
        [this] { runLoop(); }, logRealtime);
    watch();
    loop_thread.join();
    statistics_.final_phase = phase();
}

void Emulator::runLoop() {
    const int64_t start_ns = monotonicNowNs();
    PeriodicTimer timer(period_ns_, start_ns);
    do {
        listenUntil(timer.advance(monotonicNowNs()));
        tick(monotonicNowNs());
    } while (!hasLeft(monotonicNowNs()));
    finish(start_ns, timer.missedPeriods());
}

// The forces of a command hold from when it has come.
void Emulator::listenUntil(int64_t instant_ns) noexcept {
    const RtScope no_heap_no_locks;
    for (int64_t now_ns = monotonicNowNs(); now_ns < instant_ns; now_ns = monotonicNowNs()) {
        const int64_t due_ns = std::min(from_host_.nextDueNs(), to_host_.nextDueNs());
        socket_.waitUntil(std::min(instant_ns, due_ns));
        now_ns = monotonicNowNs();
        takeDatagrams(now_ns);
        deliverCommands(now_ns);
        deliverStates(now_ns);
    }
}

void Emulator::takeDatagrams(int64_t now_ns) noexcept {
    for (int i = 0; i < wire::kDatagramsAtOnce; ++i) {
        std::array<std::byte, wire::kMaxPacket> buffer;
        wire::Endpoint source;
        const auto bytes = socket_.receive(buffer, source);
        if (bytes.empty()) return;
        from_host_.put(bytes, source, controller_.engagedSeconds(now_ns), now_ns);
    }
}

void Emulator::deliverCommands(int64_t now_ns) noexcept {
    FaultyWire::Datagram datagram;
    while (from_host_.take(datagram, now_ns)) {
        auto& session = controller_.session();
        const wire::Taken taken = session.take(datagram.content(), datagram.other, now_ns);
        if (taken == wire::Taken::kCommand) controller_.obey(now_ns);
        if (taken != wire::Taken::kRequest) continue;
        to_host_.put(session.sealDescription(), session.host(), controller_.engagedSeconds(now_ns), now_ns);
    }
}

void Emulator::deliverStates(int64_t now_ns) noexcept {
    FaultyWire::Datagram datagram;
    while (to_host_.take(datagram, now_ns)) {
        if (socket_.send(datagram.content(), datagram.other)) ++statistics_.packets_sent;
    }
}

void Emulator::tick(int64_t now_ns) noexcept {
    const RtScope no_heap_no_locks;
    takeDatagrams(now_ns);
    deliverCommands(now_ns);
    obeyHandOrder();
    wire::JointState state;
    controller_.period(now_ns, state);
    auto& session = controller_.session();
    if (session.hasHost()) {
        session.seal(state, now_ns);
        to_host_.put(wire::bytesOf(state), session.host(), controller_.engagedSeconds(now_ns), now_ns);
    }
    deliverStates(now_ns);
    record();
}

void Emulator::obeyHandOrder() noexcept {
    const HandOrder order = hand_order_.exchange(HandOrder::kNone, std::memory_order_relaxed);
    if (order == HandOrder::kBeginAnew) controller_.beginAnew();
    if (order == HandOrder::kRest) controller_.rest();
}

void Emulator::record() noexcept {
    const EmulatorState& plant = controller_.plant();
    EmulatorStatistics& s = statistics_;
    ++s.ticks;
    s.max_tracking_error =
        std::max(s.max_tracking_error, (plant.target.X_DT.position - plant.X_DT.position).norm());
    if (plant.at_stop) ++s.stop_ticks;

    const wire::DriveStateMachine& drive = controller_.session().drive();
    progress_.was_engaged.store(controller_.wasEngaged(), std::memory_order_relaxed);
    progress_.waypoint.store(plant.target.waypoint, std::memory_order_relaxed);
    progress_.scenario_time.store(plant.scenario_time, std::memory_order_relaxed);
    progress_.fault.store(drive.firstFault(), std::memory_order_relaxed);
}

bool Emulator::shouldEnd() const noexcept {
    return should_stop_.load(std::memory_order_relaxed) || controller_.plant().scenario_time >= end_time_;
}

bool Emulator::hasLeft(int64_t now_ns) noexcept {
    if (!shouldEnd()) return false;
    if (leaving_since_ns_ == 0) {
        leaving_since_ns_ = now_ns;
        controller_.leave();
    }
    const int64_t leaving_ns = now_ns - leaving_since_ns_;
    const bool is_on = controller_.session().drive().state() == wire::DriveState::kOperationEnabled;
    return !controller_.session().hasHost() || leaving_ns >= kLongestGoodbyeNs ||
           (leaving_ns >= kShortestGoodbyeNs && !is_on);
}

void Emulator::finish(int64_t start_ns, uint64_t missed_periods) {
    statistics_.wall_time = secondsOfNs(monotonicNowNs() - start_ns);
    statistics_.missed_periods = missed_periods;
    statistics_.scenario_time = controller_.plant().scenario_time;
    statistics_.commands = controller_.session().statistics();
    statistics_.watchdog_trips = controller_.session().watchdogTrips();
    progress_.is_finished = true;
}

void Emulator::watch() {
    spdlog::info("emulated controller runs at {} Hz on {}; waiting for device_daemon", rate_hz_,
                 wire::textOf(socket_.local()));
    int shown_waypoint = -2;
    uint32_t shown_fault = 0;
    while (!progress_.is_finished) {
        if (stop_signals_.await(kWatchPeriodNs) && !should_stop_) {
            spdlog::info("stopping: the host is told to switch off");
            should_stop_ = true;
        }
        hearHandOrders();
        reportProgress(shown_waypoint, shown_fault);
    }
}

// Of several the newest counts.
void Emulator::hearHandOrders() {
    for (HandOrder order = takeHandOrder(); order != HandOrder::kNone; order = takeHandOrder()) {
        spdlog::info("the hand {}", order == HandOrder::kBeginAnew ? "begins anew" : "rests");
        hand_order_ = order;
    }
}

void Emulator::reportProgress(int& shown_waypoint, uint32_t& shown_fault) const {
    const double t = progress_.scenario_time;
    const int waypoint = progress_.waypoint;
    if (progress_.was_engaged && waypoint != shown_waypoint) {
        const bool is_new =
            shown_waypoint < -1 || phaseOf(scenario_, waypoint) != phaseOf(scenario_, shown_waypoint);
        if (is_new) spdlog::info("{:8.3f} s  phase {}", t, phaseOf(scenario_, waypoint));
        shown_waypoint = waypoint;
    }
    const uint32_t fault = progress_.fault;
    if (fault != shown_fault) {
        if (fault != 0)
            spdlog::warn("{:8.3f} s  fault {:#x}: the motors brake", t, fault);
        else
            spdlog::info("{:8.3f} s  fault reset", t);
        shown_fault = fault;
    }
}

std::string Emulator::phase() const {
    return progress_.was_engaged ? phaseOf(scenario_, progress_.waypoint) : "waiting for device_daemon";
}

}  // namespace bonemill
