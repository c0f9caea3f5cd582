#include "haptic_server/server/session/tick_recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {

Recorder::Recorder(SpscRing<TickRecord>& ring, int64_t period_ns, const RecordedEffects& recorded,
                   std::optional<BreachMonitor> breach)
    : ring_(ring),
      statistics_(period_ns, recorded),
      recorded_(recorded),
      breach_(std::move(breach)),
      attempt_{.max_force = 0, .effects = EffectStatistics(recorded)},
      shown_attempt_(attempt_) {}

void Recorder::openTrace(const std::string& path) {
    if (!path.empty()) trace_.emplace(path, recorded_);
}

void Recorder::drain() {
    TickRecord record;
    bool any = false;
    EventSum events;
    double removed = 0;
    const size_t known_changes = statistics_.device().kept().size();
    const std::lock_guard technique_lock(technique_mutex_);
    takeUpAttempt();
    while (ring_.tryPop(record)) {
        any = true;
        statistics_.add(record);
        if (trace_ && !trace_->write(record)) is_trace_torn_ = true;
        if (journal_) journal_->add(record);
        addToWindow(record);
        addToAttempt(record);
        ticks_ = record.tick + 1;
        keepForAll(record);
        events.add(record.effects);
        removed += record.removed;
    }
    if (journal_) journal_->round();
    const bool is_incomplete = isIncomplete();
    const std::lock_guard lock(mutex_);
    if (is_incomplete) health_.faults |= kFaultNotRecorded;
    if (!any) return;
    latest_ = record;
    new_events_.add(events);
    new_removed_ += removed;
    const auto changes = statistics_.device().kept().subspan(known_changes);
    new_device_changes_.insert(new_device_changes_.end(), changes.begin(), changes.end());
    health_.ticks = statistics_.ticks();
    health_.dropped_ticks = statistics_.droppedTicks();
    health_.faults = statistics_.faults() | (health_.faults & kFaultNotRecorded);
    if (!asked_bone_order_) shown_attempt_ = attempt_;
}

bool Recorder::isIncomplete() const {
    return is_trace_torn_ || ring_.dropped() > 0 || (journal_ && !journal_->problem().empty());
}

void Recorder::beginAttempt(uint64_t bone_order) {
    const std::lock_guard lock(mutex_);
    asked_bone_order_ = bone_order;
    shown_attempt_ = {.max_force = 0, .effects = EffectStatistics(recorded_)};
}

void Recorder::takeUpAttempt() {
    const std::lock_guard lock(mutex_);
    if (asked_bone_order_) beginAsked();
    if (technique_ && p_eye_W_) technique_->setEye(*p_eye_W_);
}

void Recorder::beginAsked() {
    bone_order_ = *std::exchange(asked_bone_order_, std::nullopt);
    attempt_ = shown_attempt_;
    attempt_end_ = ticks_;
    if (make_technique_) technique_ = make_technique_();
    if (breach_) breach_->reset();
}

void Recorder::addToAttempt(const TickRecord& record) {
    if (record.bone_order < bone_order_ || (end_after_ && record.tick >= *end_after_)) return;
    attempt_end_ = record.tick + 1;
    if (const TickStep step{record, 0}; step.isInContact())
        attempt_.max_force = std::max(attempt_.max_force, step.force());
    attempt_.effects.add(record.effects);
    if (technique_) technique_->add(record);
    if (!breach_) return;
    breach_->add(record);
    attempt_.breach = breach_->depth();
}

void Recorder::setEye(const Eigen::Vector3d& p_eye_W) {
    const std::lock_guard lock(mutex_);
    p_eye_W_ = p_eye_W;
}

// Nothing, while ticks are missing that may still come.
std::optional<EndedAttempt> Recorder::takeAttempt(uint64_t ticks, bool waits) {
    const std::lock_guard technique_lock(technique_mutex_);
    end_after_ = std::max(ticks, ticks_);
    if (ticks_ < ticks && waits) return std::nullopt;
    end_after_.reset();
    const std::lock_guard lock(mutex_);
    return EndedAttempt{asked_bone_order_ ? shown_attempt_ : attempt_, std::exchange(technique_, nullptr),
                        attempt_end_};
}

EndedAttempt Recorder::endAttempt(uint64_t ticks) {
    constexpr int kLooks = 50;  // a millisecond each
    std::optional<EndedAttempt> ended;
    for (int look = 0; !(ended = takeAttempt(ticks, look < kLooks)); ++look)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (!ended->technique) return *std::move(ended);
    ended->technique->finish();
    // What is measured weighs by time: the first tick has none.
    const Figures figures = ended->technique->figures();
    if (const Figure* const most = findFigure(figures, "force.max")) ended->figures.max_force = most->value;
    return *std::move(ended);
}

AttemptFigures Recorder::attempt() const {
    const std::lock_guard lock(mutex_);
    return shown_attempt_;
}

void Recorder::addToWindow(const TickRecord& record) {
    if (window_start_ns_ == 0) window_start_ns_ = record.start_ns;
    const int64_t elapsed = record.start_ns - window_start_ns_;
    if (elapsed >= kNsPerSecond) {
        const std::lock_guard lock(mutex_);
        health_.rate_hz = double(window_.count()) / secondsOfNs(elapsed);
        health_.tick_p50_us = microsecondsOfNs(double(window_.percentileNs(50)));
        health_.tick_p99_us = microsecondsOfNs(double(window_.percentileNs(99)));
        health_.tick_max_us = microsecondsOfNs(double(window_.maxNs()));
        window_ = {};
        window_start_ns_ = record.start_ns;
    }
    window_.record(record.compute_ns);
}

bool Recorder::finish() {
    drain();
    if (journal_) journal_->finish();
    statistics_.setLostRecords(ring_.dropped());
    if (!trace_) return true;
    const bool is_written = trace_->close();
    return is_written && statistics_.lostRecords() == 0;
}

std::optional<TickRecord> Recorder::latest() const {
    const std::lock_guard lock(mutex_);
    return latest_;
}

std::optional<Recorder::Since> Recorder::takeSince() {
    const std::lock_guard lock(mutex_);
    if (!latest_) return std::nullopt;
    return Since{*latest_, std::exchange(new_events_, {}), std::exchange(new_removed_, 0)};
}

void Recorder::keepForAll(const TickRecord& record) {
    const std::lock_guard lock(mutex_);
    if (!keeps_all_) return;
    all_.push_back(record);
    if (all_.size() <= kMostKept) return;
    all_ = {};
    keeps_all_ = false;
}

std::vector<TickRecord> Recorder::takeAll() {
    const std::lock_guard lock(mutex_);
    keeps_all_ = true;
    return std::exchange(all_, {});
}

std::vector<DeviceChange> Recorder::takeDeviceChanges() {
    const std::lock_guard lock(mutex_);
    return std::exchange(new_device_changes_, {});
}

LoopHealth Recorder::health() const {
    const std::lock_guard lock(mutex_);
    return health_;
}

}  // namespace bonemill
