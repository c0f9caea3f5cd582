#include "device_daemon/apps/device_daemon/daemon.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <limits>
#include <utility>

#include "common/base/user_error.h"
#include "common/log/log.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "common/rt/rt_guard.h"
#include "device_daemon/control/device_loop/black_box.h"

namespace bonemill {
namespace {

constexpr int64_t kWatchPeriodNs = 50 * kNsPerMillisecond;
constexpr int64_t kLongestSilenceNs = 2 * kNsPerSecond;  // of a device that is there, at the start
constexpr double kForEver = std::numeric_limits<double>::infinity();

DeviceLoopConfig loopConfigOf(const DeviceSetup& setup, const DaemonOptions& options) {
    DeviceLoopConfig config = setup.loop;
    config.states.needs_enabling_switch = options.has_enabling_switch;
    return config;
}

}  // namespace

Daemon::Daemon(const FollowedScene& scene, const DaemonOptions& options, HapticDevice& device,
               ChildProgram* program, const StopSignals& stop_signals, DeviceLink& link, DaemonMemory& memory)
    : scene_(scene),
      options_(options),
      device_(device),
      program_(program),
      stop_signals_(stop_signals),
      loop_(device, loopConfigOf(scene.setup, options), memory.stop),
      link_(link),
      period_ns_(std::llround(kNsPerSecond / scene.setup.rate_hz)),
      scene_revision_(scene.revision),
      memory_(memory),
      statistics_(memory.statistics) {
    progress_.cause = memory.stop.cause;  // it is counted already
}

Daemon::End Daemon::run() {
    RealtimeThread loop_thread(
        {.request = {.core = options_.core},
         .is_strict = options_.is_strict_realtime,
         .what = "the device loop"},
        [this] { runLoop(); }, logRealtime);
    // A stop that came last is written when nothing more can come.
    const auto end = [&] {
        loop_thread.join();
        if (loop_.blackBox().isFull()) writeBlackBox();
    };
    try {
        watch();
    } catch (...) {
        should_stop_ = true;
        end();
        throw;
    }
    end();
    return is_run_over_ && !should_stop_ ? End::kOtherSceneOrHand : End::kLeft;
}

void Daemon::runLoop() {
    memory_.between.reset();
    const int64_t start_ns = monotonicNowNs();
    PeriodicTimer timer(period_ns_, start_ns);
    const bool has_clock = device_.hasClock();
    int64_t last_ns = start_ns;
    while (!loop_.isReleased()) {
        int64_t instant_ns = 0;
        if (has_clock) {
            // A device that has fallen silent is looked after at the loop's own pace.
            device_.waitForSample(last_ns + 2 * period_ns_);
            instant_ns = monotonicNowNs();
        } else {
            instant_ns = timer.waitNext();
        }
        tick(instant_ns, secondsOfNs(instant_ns - last_ns));
        last_ns = instant_ns;
        if (shouldEnd()) {
            loop_.release();
            is_ending_ = true;  // what happens now is its own doing
        }
    }
    if (!is_run_over_ || should_stop_)
        sayGoodbye(link_, memory_);
    else if (is_hand_over_ && memory_.last_sample)
        memory_.between.emplace(link_, *memory_.last_sample);
    loop_.blackBox().finish();
    statistics_.wall_time += secondsOfNs(monotonicNowNs() - start_ns);
    statistics_.missed_periods += timer.missedPeriods();
    statistics_.unheard_periods += loop_.unheardPeriods();
    statistics_.final_state = nameOf(loop_.safety().state());
    memory_.stop = loop_.safety().latch();
    progress_.is_finished = true;
}

void Daemon::tick(int64_t instant_ns, double elapsed) noexcept {
    const RtScope no_heap_no_locks;
    const int64_t woke_ns = monotonicNowNs();

    DeviceSample sample;
    bool has_sample = loop_.read(woke_ns, elapsed, sample);
    if (!has_sample && isAfterAnotherHand()) {
        sample = restingAt(*memory_.last_sample, woke_ns);
        has_sample = true;
    }
    if (has_sample) publish(sample);
    WrenchCommand command;
    const bool has_command = link_.readCommand(command) &&
                             command.scene_revision == scene_revision_.load(std::memory_order_relaxed);
    if (has_command) noteAttached(command);
    // What an earlier run left in the memory answers earlier samples.
    const bool is_for_us = has_command && progress_.is_attached.load(std::memory_order_relaxed);
    loop_.write(is_for_us ? &command : nullptr, monotonicNowNs());

    if (elapsed > 0) statistics_.period.record(int64_t(elapsed * kNsPerSecond));
    if (!device_.hasClock()) statistics_.wakeup_latency.record(woke_ns - instant_ns);
    statistics_.compute_time.record(monotonicNowNs() - woke_ns);
    recordTick(is_for_us ? &command : nullptr);
}

// The last sample is of another device of this scene as long as this one has said nothing.
bool Daemon::isAfterAnotherHand() const noexcept {
    return memory_.last_sample &&
           memory_.last_sample->scene_revision == scene_revision_.load(std::memory_order_relaxed);
}

// A device that is faster than the loop of the scene is felt at its own pace; the server gets what it asked
// for.
void Daemon::publish(DeviceSample& sample) noexcept {
    const int64_t now_ns = monotonicNowNs();
    if (now_ns < publish_at_ns_ - period_ns_ / 2) return;
    publish_at_ns_ = std::max(publish_at_ns_ + period_ns_, now_ns);
    if (device_.capabilitiesVersion() != capabilities_version_) {
        capabilities_version_ = device_.capabilitiesVersion();
        link_.writeCapabilities(device_.capabilities());
    }
    sample.scene_revision = scene_revision_.load(std::memory_order_relaxed);
    last_sequence_ = link_.writeSample(sample);
    memory_.last_sample = sample;
    if (first_sequence_ == 0) first_sequence_ = last_sequence_;
}

void Daemon::noteAttached(const WrenchCommand& command) noexcept {
    const bool answers_this_run = first_sequence_ != 0 && command.answers_sequence >= first_sequence_ &&
                                  command.answers_sequence <= last_sequence_;
    if (!answers_this_run || progress_.is_attached.load(std::memory_order_relaxed)) return;
    if (statistics_.attached_ns == 0) statistics_.attached_ns = monotonicNowNs();
    progress_.is_attached.store(true, std::memory_order_relaxed);
}

void Daemon::recordTick(const WrenchCommand* command) noexcept {
    LoopStatistics& s = statistics_;
    ++s.ticks;
    if (command) {
        ++s.attached_ticks;
        if (command->answers_sequence + 1 < last_sequence_) ++s.late_answers;
    }
    s.max_force = std::max(s.max_force, loop_.given().force.norm());
    s.max_torque = std::max(s.max_torque, loop_.given().torque.norm());
    const SafetyStates& safety = loop_.safety();
    if (safety.state() == SafetyState::kEngaged) {
        ++s.engaged_ticks;
        if (loop_.limitEvents() & kWrenchClamped) ++s.clamped_ticks;
        if (loop_.limitEvents() & kWrenchRateLimited) ++s.rate_limited_ticks;
    }
    if (safety.cause() != StopCause::kNone && progress_.cause == StopCause::kNone) ++s.stops;

    progress_.is_server_there.store(loop_.isServerThere(), std::memory_order_relaxed);
    progress_.abilities.store(loop_.abilities(), std::memory_order_relaxed);
    progress_.refused_figure.store(device_.refusedFigure(), std::memory_order_relaxed);
    progress_.fault_code.store(safety.faultCode(), std::memory_order_relaxed);
    progress_.cause.store(safety.cause(), std::memory_order_relaxed);
    progress_.state.store(safety.state(), std::memory_order_relaxed);
}

bool Daemon::shouldEnd() const noexcept {
    const bool is_over = options_.seconds && statistics_.attached_ns != 0 &&
                         secondsOfNs(monotonicNowNs() - statistics_.attached_ns) > *options_.seconds;
    return is_over || should_stop_.load(std::memory_order_relaxed) ||
           is_run_over_.load(std::memory_order_relaxed) || (loop_.reading().status & kStatusLeaving);
}

void Daemon::watch() {
    spdlog::info("device loop runs at {} Hz, session {}; waiting for haptic_server", scene_.setup.rate_hz,
                 options_.session);
    const double give_up_s = options_.wait_seconds.value_or(kForEver);
    const int64_t start_ns = monotonicNowNs();
    SafetyState shown_state = SafetyState::kDisconnected;
    StopCause shown_cause = StopCause::kNone;
    bool was_server_there = false, is_silence_said = false;
    while (!progress_.is_finished) {
        if (stop_signals_.await(kWatchPeriodNs) && !should_stop_) {
            spdlog::info("stopping: force ramps to zero");
            should_stop_ = true;
        }
        lookForNotice();
        if (const std::string why = device_.refusal(); !why.empty()) throw UserError(why);
        if (!is_ending_) reportState(shown_state, shown_cause);
        if (!is_silence_said && monotonicNowNs() - start_ns > kLongestSilenceNs) {
            warnOfSilentDevice();
            is_silence_said = true;
        }
        if (loop_.blackBox().isFull()) writeBlackBox();
        if (program_ && !is_ending_) program_->lookAfter();
        if (progress_.is_attached) {
            reportServer(was_server_there);
        } else if (secondsOfNs(monotonicNowNs() - start_ns) > give_up_s) {
            throw UserError(fmt::format(
                "no haptic_server has answered within {} s: start it with the same --session ({})", give_up_s,
                options_.session));
        }
    }
}

// A server that is started anew announces the same scene once more, and nothing changes.
void Daemon::lookForNotice() {
    SceneNotice notice;
    if (is_run_over_ || !link_.readScene(notice)) return;
    if (notice.revision == scene_revision_) {
        followHand(notice);
        return followAttempts(notice);
    }
    attempt_changes_.reset();
    hand_repeats_.reset();
    if (notice.hash == scene_.hash) {
        scene_revision_ = notice.revision;
        device_.followRun(notice.epoch);
        return;
    }
    spdlog::info("haptic_server changes to {}: force ramps to zero", notice.path);
    is_run_over_ = true;
}

// Who comes to be the hand has heard of no order before: it is at its beginning anyway.
void Daemon::followHand(const SceneNotice& notice) {
    const HandChoice wanted = handFor(notice, options_);
    if (wanted != scene_.hand) {
        spdlog::info("haptic_server wants {} to be the hand: force ramps to zero",
                     wanted == HandChoice::kPointer ? "a viewer's mouse" : "the script");
        is_hand_over_ = true;
        is_run_over_ = true;
        return;
    }
    const std::optional<uint32_t> before = std::exchange(hand_repeats_, notice.hand_repeats);
    if (before && *before != notice.hand_repeats && program_) program_->tell(HandOrder::kBeginAnew);
}

// Nothing has happened before the first look at a scene.
void Daemon::followAttempts(const SceneNotice& notice) {
    const std::optional<uint32_t> before = std::exchange(attempt_changes_, notice.attempt_changes);
    if (!before || *before == notice.attempt_changes) return;
    const bool is_running = notice.attempt_changes % 2 == 1;
    spdlog::info("an attempt {}", is_running ? "begins" : "has ended");
    if (is_running) device_.beginAttempt();
    if (program_) program_->tell(is_running ? HandOrder::kBeginAnew : HandOrder::kRest);
}

void Daemon::reportServer(bool& was_there) const {
    const bool is_there = progress_.is_server_there;
    if (is_there == was_there || is_ending_) return;
    if (is_there)
        spdlog::info("haptic_server answers");
    else
        spdlog::warn("haptic_server is silent: force ramps to zero");
    was_there = is_there;
}

void Daemon::reportState(SafetyState& shown_state, StopCause& shown_cause) const {
    const SafetyState state = progress_.state;
    const StopCause cause = progress_.cause;
    if (cause != shown_cause && cause != StopCause::kNone) {
        const uint32_t code = progress_.fault_code;
        spdlog::error("{}: {}{}. {}", nameOf(state), nameOf(cause),
                      code == 0 ? "" : " " + std::to_string(code), whatToDo(cause));
    } else if (state != shown_state) {
        spdlog::info("device is {}", nameOf(state));
        if (state == SafetyState::kReady) warnOfMissingSwitch();
    }
    shown_state = state;
    shown_cause = cause;
}

void Daemon::warnOfSilentDevice() const {
    if (progress_.state != SafetyState::kDisconnected || is_ending_) return;
    if (const char* figure = progress_.refused_figure)
        spdlog::warn("the device is refused for the {} that it describes itself with: mend it in its program",
                     figure);
    else
        spdlog::warn("the device does not answer: device_daemon --list says what is there");
}

void Daemon::warnOfMissingSwitch() const {
    const uint32_t abilities = progress_.abilities;
    if (!options_.has_enabling_switch || (abilities & (kAbilityEnablingSwitch | kAbilitySimulated))) return;
    spdlog::warn(
        "this device has no enabling switch and will not engage: start with --no-enabling-switch if you "
        "accept that it engages by itself");
}

void Daemon::writeBlackBox() {
    const std::filesystem::path file =
        stopFile(options_.stop_dir, options_.session, loop_.blackBox().cause());
    try {
        loop_.blackBox().write(file);
        spdlog::info("the last two seconds are in {}", file.string());
    } catch (const UserError& error) {
        spdlog::warn("{}", error.what());
    }
}

}  // namespace bonemill
