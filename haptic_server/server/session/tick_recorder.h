// The recorder thread works with this: it empties the tick's ring into trace and statistics and keeps the
// newest record at hand.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

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
    double max_force = 0;  // N, of the wrench on the hand while the tool touches something
    EffectStatistics effects;
    std::optional<double> breach = {};  // m beside the task's planned line; none without one
};

// An attempt up to one tick, which is the same for all of it.
struct EndedAttempt {
    AttemptFigures figures;
    std::unique_ptr<Technique> technique;  // finished; null: it was not measured, or had not begun
    uint64_t end = 0;                      // ticks of the session up to there
};

class Recorder {
  public:
    // `recorded` says what the records hold of effects; `breach` is there where the task has a planned line.
    Recorder(SpscRing<TickRecord>& ring, int64_t period_ns, const RecordedEffects& recorded = {},
             std::optional<BreachMonitor> breach = {});

    // Before the first drain(), it begins a trace, which takes the place of the file that is there; an empty
    // path is none. Throws UserError when it cannot be created.
    void openTrace(const std::string& path);
    // Likewise: all records go into the journal as well, which must outlive this.
    void keepJournal(Journal* journal) { journal_ = journal; }
    // The recorder thread takes what is in the ring, every few milliseconds.
    void drain();
    // Once the tick has ended this takes the rest and closes the trace. False: some of the trace is lost,
    // because it could not be written or because the ring was full (statistics().lostRecords()).
    bool finish();

    // Any normal thread may ask.
    std::optional<TickRecord> latest() const;
    // It is the newest record, with what happened in all ticks since the call before.
    struct Since {
        TickRecord latest;
        EventSum events;
        double removed;  // m³
    };
    std::optional<Since> takeSince();
    // All records since the call before, the oldest first, for whoever calls it often: with the first call it
    // begins to keep them, and ends when it was not called for kMostKept ticks.
    std::vector<TickRecord> takeAll();
    static constexpr size_t kMostKept = 1000;
    // These changes of the device are new since the call before.
    std::vector<DeviceChange> takeDeviceChanges();
    LoopHealth health() const;
    // Any normal thread begins an attempt: its figures count from the first record on that says that this
    // order to put the bone back is done. Then nothing is damaged or dead any more.
    void beginAttempt(uint64_t bone_order);
    AttemptFigures attempt() const;
    // Before the first drain(): every attempt from now on is measured, too, by what this makes (not null).
    using MakeTechnique = std::function<std::unique_ptr<Technique>()>;
    void measureTechnique(MakeTechnique make) { make_technique_ = std::move(make); }
    // Any normal thread ends the attempt behind its first `ticks` ticks of the session, or behind the newest
    // that was taken from the ring, if that is later; it waits some milliseconds for them, and not for ticks
    // that do not come.
    EndedAttempt endAttempt(uint64_t ticks);
    // Any normal thread tells where the trainee's eye is, whenever it moves.
    void setEye(const Eigen::Vector3d& p_eye_W);
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
    void addToWindow(const TickRecord& record);
    void takeUpAttempt();
    void beginAsked();
    std::optional<EndedAttempt> takeAttempt(uint64_t ticks, bool waits);
    bool isIncomplete() const;
    void keepForAll(const TickRecord& record);
    void addToAttempt(const TickRecord& record);

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
    uint64_t ticks_ = 0;       // of the session, taken from the ring
    MakeTechnique make_technique_;
    std::mutex technique_mutex_;  // guards what is below; held for as long as a drain()
    std::unique_ptr<Technique> technique_;
    uint64_t attempt_end_ = 0;           // EndedAttempt::end, up to now
    std::optional<uint64_t> end_after_;  // ticks of the session: the attempt is about to end
    mutable std::mutex mutex_;           // guards what is below
    std::optional<TickRecord> latest_;
    EventSum new_events_;  // since takeSince()
    double new_removed_ = 0;
    bool keeps_all_ = false;
    std::vector<TickRecord> all_;                   // since takeAll()
    std::vector<DeviceChange> new_device_changes_;  // since takeDeviceChanges()
    LoopHealth health_;
    AttemptFigures shown_attempt_;  // as of latest_
    std::optional<Eigen::Vector3d> p_eye_W_;
    std::optional<uint64_t> asked_bone_order_;  // by beginAttempt()
};

}  // namespace bonemill
