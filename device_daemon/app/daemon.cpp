#include "device_daemon/app/daemon.h"

#include <signal.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <limits>

#include "common/log/log.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime_thread.h"
#include "common/rt/rt_guard.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

constexpr int64_t kWatchPeriodNs = 50 * kNsPerMillisecond;
constexpr double kForEver = std::numeric_limits<double>::infinity();

double endTimeOf(const DeviceSetup& setup, const DaemonOptions& options) {
    const bool has_path = !setup.phases.empty();
    const double path_end = has_path && !options.hold ? setup.path.duration() : kForEver;
    return std::min(path_end, options.seconds.value_or(kForEver));
}

// Waits for SIGINT or SIGTERM, and returns false after kWatchPeriodNs without one.
bool waitForSignal() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    const timespec timeout = timespecOfNs(kWatchPeriodNs);
    return sigtimedwait(&signals, nullptr, &timeout) > 0;
}

}  // namespace

Daemon::Daemon(const DeviceSetup& setup, const DaemonOptions& options)
    : setup_(setup),
      options_(options),
      end_time_(endTimeOf(setup, options)),
      kinematics_(setup.geometry),
      emulator_(kinematics_, setup.plant, setup.hand, setup.path),
      loop_(kinematics_, emulator_, setup.loop, emulator_.state().X_DT),
      link_(DeviceLink::create(options.session, LinkSide::kDaemon, setup.scene_hash)) {}

void Daemon::run() {
    RealtimeThread loop_thread(
        {.request = {.core = options_.core},
         .best_effort = options_.best_effort_realtime,
         .what = "the device loop"},
        [this] { runLoop(); }, logRealtime);
    try {
        watch();
    } catch (...) {
        should_stop_ = true;
        throw;
    }
    loop_thread.join();
    statistics_.final_phase = phaseOf(progress_.waypoint);
}

void Daemon::runLoop() {
    const int64_t period_ns = std::llround(kNsPerSecond / setup_.rate_hz);
    const int64_t start_ns = monotonicNowNs();
    PeriodicTimer timer(period_ns, start_ns);
    int64_t last_instant_ns = start_ns;
    while (!loop_.isReleased()) {
        const int64_t instant_ns = timer.waitNext();
        tick(instant_ns, secondsOfNs(instant_ns - last_instant_ns));
        last_instant_ns = instant_ns;
        if (shouldEnd()) loop_.release();
    }
    sayGoodbye();
    statistics_.wall_time = secondsOfNs(monotonicNowNs() - start_ns);
    statistics_.missed_periods = timer.missedPeriods();
    statistics_.scenario_time = emulator_.state().scenario_time;
    statistics_.failed_poses = loop_.failedPoses();
    progress_.is_finished = true;
}

void Daemon::tick(int64_t instant_ns, double elapsed) noexcept {
    const RtScope no_heap_no_locks;
    const int64_t woke_ns = monotonicNowNs();

    DeviceSample sample;
    if (loop_.read(elapsed, sample)) {
        sample.stamp_ns = monotonicNowNs();
        last_sequence_ = link_.writeSample(sample);
        last_sample_ = sample;
        if (first_sequence_ == 0) first_sequence_ = last_sequence_;
    }
    WrenchCommand command;
    const bool has_command = link_.readCommand(command);
    if (has_command) attachToServer(command, last_sequence_);
    loop_.write(has_command ? &command : nullptr, monotonicNowNs());

    statistics_.wakeup_latency.record(woke_ns - instant_ns);
    statistics_.compute_time.record(monotonicNowNs() - woke_ns);
    recordTick(has_command ? &command : nullptr, last_sequence_);
}

// Lets the server tell an orderly end from a fault.
void Daemon::sayGoodbye() noexcept {
    if (first_sequence_ == 0) return;
    last_sample_.stamp_ns = monotonicNowNs();
    last_sample_.flags |= kDeviceFlagLeaving;
    link_.writeSample(last_sample_);
}

void Daemon::attachToServer(const WrenchCommand& command, uint64_t sequence) noexcept {
    // What an earlier run left in the memory answers earlier samples.
    const bool answers_this_run = first_sequence_ != 0 && command.answers_sequence >= first_sequence_ &&
                                  command.answers_sequence <= sequence;
    if (!answers_this_run || progress_.is_attached.load(std::memory_order_relaxed)) return;
    emulator_.startScenario();
    progress_.is_attached.store(true, std::memory_order_relaxed);
}

void Daemon::recordTick(const WrenchCommand* command, uint64_t sequence) noexcept {
    const EmulatorState& state = emulator_.state();
    LoopStatistics& s = statistics_;
    ++s.ticks;
    if (progress_.is_attached.load(std::memory_order_relaxed)) {
        ++s.attached_ticks;
        if (!command || command->answers_sequence + 1 < sequence) ++s.late_answers;
    }
    s.max_tracking_error =
        std::max(s.max_tracking_error, (state.target.X_DT.position - state.X_DT.position).norm());
    s.max_force = std::max(s.max_force, loop_.appliedWrench().force.norm());
    s.max_torque = std::max(s.max_torque, loop_.appliedWrench().torque.norm());
    if (loop_.limitEvents() & kForceClamped) ++s.clipped_ticks;
    if (loop_.limitEvents() & kForceRateLimited) ++s.rate_limited_ticks;
    if (state.at_stop) ++s.stop_ticks;

    // While this side ends the run, silence is its own doing.
    progress_.is_stale.store(loop_.isPeerStale() && !shouldEnd(), std::memory_order_relaxed);
    progress_.waypoint.store(state.target.waypoint, std::memory_order_relaxed);
    progress_.scenario_time.store(state.scenario_time, std::memory_order_relaxed);
}

bool Daemon::shouldEnd() const noexcept {
    return should_stop_.load(std::memory_order_relaxed) || emulator_.state().scenario_time >= end_time_;
}

void Daemon::watch() {
    spdlog::info("device loop runs at {} Hz, session {}; waiting for haptic_server", setup_.rate_hz,
                 options_.session);
    const double give_up_s = options_.wait_seconds.value_or(kForEver);
    const int64_t start_ns = monotonicNowNs();
    int shown_waypoint = -2;
    bool shown_stale = true;
    while (!progress_.is_finished) {
        if (waitForSignal() && !should_stop_) {
            spdlog::info("stopping: force ramps to zero");
            should_stop_ = true;
        }
        if (progress_.is_attached) {
            reportProgress(shown_waypoint, shown_stale);
        } else if (secondsOfNs(monotonicNowNs() - start_ns) > give_up_s) {
            throw UserError("no haptic_server has answered within " + std::to_string(*options_.wait_seconds) +
                            " s: start it with the same --session (" + std::to_string(options_.session) +
                            ")");
        }
    }
}

void Daemon::reportProgress(int& shown_waypoint, bool& shown_stale) const {
    const double t = progress_.scenario_time;
    const int waypoint = progress_.waypoint;
    if (waypoint != shown_waypoint) {
        const bool is_new_phase = shown_waypoint < -1 || phaseOf(waypoint) != phaseOf(shown_waypoint);
        if (is_new_phase) spdlog::info("{:8.3f} s  phase {}", t, phaseOf(waypoint));
        shown_waypoint = waypoint;
    }
    const bool is_stale = progress_.is_stale;
    if (is_stale != shown_stale && !progress_.is_finished) {
        if (is_stale)
            spdlog::warn("{:8.3f} s  haptic_server is silent: force ramps to zero", t);
        else
            spdlog::info("{:8.3f} s  haptic_server answers", t);
        shown_stale = is_stale;
    }
}

std::string Daemon::phaseOf(int waypoint) const {
    if (!progress_.is_attached) return "waiting for haptic_server";
    if (waypoint < 0 || setup_.phases[waypoint].empty()) return "hold";
    return setup_.phases[waypoint];
}

}  // namespace bonemill
