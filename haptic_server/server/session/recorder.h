// The recorder thread works with this: it empties the tick's ring into trace and statistics and keeps the
// newest record at hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "common/rt/clock.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/assessment/measures/technique.h"
#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/recording/statistics/effect_statistics.h"
#include "haptic_server/recording/statistics/run_statistics.h"
#include "haptic_server/recording/statistics/tick_columns.h"

namespace bonemill {

// Clients are shown this of the loop's health.
struct LoopHealth {
    uint64_t ticks = 0;
    double rate_hz = 0;      // over the last full second
    double tick_p50_us = 0;  // of the same second
    double tick_p99_us = 0;
    double tick_max_us = 0;
    uint64_t dropped_ticks = 0;
    uint32_t faults = 0;
};

// What the ticks of an attempt told; before the first one, those of the session.
struct AttemptFigures {
    double max_force = 0;  // N, of the wrench on the hand
    EffectStatistics effects;
    std::optional<double> breach = {};  // m beside the task's planned line; none without one
};

class Recorder {
  public:
    // `recorded` says what the records hold of effects; `breach` is there where the task has a planned line.
    Recorder(SpscRing<TickRecord>& ring, int64_t period_ns, const RecordedEffects& recorded = {},
             std::optional<BreachMonitor> breach = {})
        : ring_(ring),
          statistics_(period_ns, recorded),
          recorded_(recorded),
          breach_(std::move(breach)),
          attempt_{.max_force = 0, .effects = EffectStatistics(recorded)},
          shown_attempt_(attempt_) {}

    // Before the first drain(), it begins a trace, which takes the place of the file that is there; an empty
    // path is none. Throws UserError when it cannot be created.
    void openTrace(const std::string& path) {
        if (!path.empty()) trace_.emplace(path, recorded_);
    }
    // Likewise: all records go into the journal as well, which must outlive this.
    void keepJournal(Journal* journal) { journal_ = journal; }
    // The recorder thread takes what is in the ring, every few milliseconds.
    void drain() {
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
    // Once the tick has ended this takes the rest and closes the trace. False: some of the trace is lost,
    // because it could not be written or because the ring was full (statistics().lostRecords()).
    bool finish() {
        drain();
        if (journal_) journal_->finish();
        statistics_.setLostRecords(ring_.dropped());
        if (!trace_) return true;
        const bool is_written = trace_->close();
        return is_written && statistics_.lostRecords() == 0;
    }

    // Any normal thread may ask.
    std::optional<TickRecord> latest() const {
        const std::lock_guard lock(mutex_);
        return latest_;
    }
    // It is the newest record, with what happened in all ticks since the call before.
    struct Since {
        TickRecord latest;
        EventSum events;
        double removed;  // m³
    };
    std::optional<Since> takeSince() {
        const std::lock_guard lock(mutex_);
        if (!latest_) return std::nullopt;
        return Since{*latest_, std::exchange(new_events_, {}), std::exchange(new_removed_, 0)};
    }
    // These changes of the device are new since the call before.
    std::vector<DeviceChange> takeDeviceChanges() {
        const std::lock_guard lock(mutex_);
        return std::exchange(new_device_changes_, {});
    }
    LoopHealth health() const {
        const std::lock_guard lock(mutex_);
        return health_;
    }
    // Any normal thread begins an attempt: its figures count from the first record on that says that this
    // order to put the bone back is done. Then nothing is damaged or dead any more.
    void beginAttempt(uint64_t bone_order) {
        const std::lock_guard lock(mutex_);
        asked_bone_order_ = bone_order;
        shown_attempt_ = {.max_force = 0, .effects = EffectStatistics(recorded_)};
    }
    AttemptFigures attempt() const {
        const std::lock_guard lock(mutex_);
        return shown_attempt_;
    }
    // Before the first drain(): every attempt from now on is measured, too, by what this makes (not null).
    using MakeTechnique = std::function<std::unique_ptr<Technique>()>;
    void measureTechnique(MakeTechnique make) { make_technique_ = std::move(make); }
    // Any normal thread ends the measuring of the attempt, and gets what was measured; null if it has not
    // begun.
    std::unique_ptr<Technique> takeTechnique() {
        const std::lock_guard lock(technique_mutex_);
        return std::exchange(technique_, nullptr);
    }
    // Any normal thread tells where the trainee's eye is, whenever it moves.
    void setEye(const Eigen::Vector3d& p_eye_W) {
        const std::lock_guard lock(mutex_);
        p_eye_W_ = p_eye_W;
    }
    // This is called before finish() and says what the tick thread's page faults were after its first second.
    void setPageFaults(const PageFaults& faults) { statistics_.setPageFaults(faults); }
    // The mesher thread says at its end how long the ticks' cuts waited for the publisher.
    void setCutToPublisher(const LatencyHistogram& cut_to_publisher) {
        statistics_.setCutToPublisher(cut_to_publisher);
    }
    // Whoever has joined the publisher thread calls this.
    void setPublished(const PublishFigures& published) { statistics_.setPublished(published); }
    // The statistics may be read after finish() only.
    const RunStatistics& statistics() const { return statistics_; }

  private:
    void addToWindow(const TickRecord& record) {
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
    void takeUpAttempt() {
        const std::lock_guard lock(mutex_);
        if (asked_bone_order_) beginAsked();
        if (technique_ && p_eye_W_) technique_->setEye(*p_eye_W_);
    }
    void beginAsked() {
        bone_order_ = *std::exchange(asked_bone_order_, std::nullopt);
        attempt_ = shown_attempt_;
        if (make_technique_) technique_ = make_technique_();
        if (breach_) breach_->reset();
    }
    bool isIncomplete() const {
        return is_trace_torn_ || ring_.dropped() > 0 || (journal_ && !journal_->problem().empty());
    }
    void addToAttempt(const TickRecord& record) {
        if (record.bone_order < bone_order_) return;
        const double(&force)[3] = record.f_hand_W;
        attempt_.max_force = std::max(attempt_.max_force, std::hypot(force[0], force[1], force[2]));
        attempt_.effects.add(record.effects);
        if (technique_) technique_->add(record);
        if (!breach_) return;
        breach_->add(record);
        attempt_.breach = breach_->depth();
    }

    SpscRing<TickRecord>& ring_;
    RunStatistics statistics_;
    RecordedEffects recorded_;
    std::optional<TraceWriter> trace_;
    bool is_trace_torn_ = false;
    Journal* journal_ = nullptr;
    LatencyHistogram window_;  // tick compute time in the second under way
    int64_t window_start_ns_ = 0;
    std::optional<BreachMonitor> breach_;
    AttemptFigures attempt_;
    uint64_t bone_order_ = 0;  // the attempt's
    MakeTechnique make_technique_;
    std::mutex technique_mutex_;  // guards what is below; held for as long as a drain()
    std::unique_ptr<Technique> technique_;
    mutable std::mutex mutex_;  // guards what is below
    std::optional<TickRecord> latest_;
    EventSum new_events_;  // since takeSince()
    double new_removed_ = 0;
    std::vector<DeviceChange> new_device_changes_;  // since takeDeviceChanges()
    LoopHealth health_;
    AttemptFigures shown_attempt_;  // as of latest_
    std::optional<Eigen::Vector3d> p_eye_W_;
    std::optional<uint64_t> asked_bone_order_;  // by beginAttempt()
};

}  // namespace bonemill
