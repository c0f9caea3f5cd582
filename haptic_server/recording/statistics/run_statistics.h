// Tells what a run was like, from its tick records: rates, latencies, contacts, forces, material, faults.
//
// One normal thread calls it; it allocates once per second of run.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/rt/latency_histogram.h"
#include "common/rt/realtime.h"
#include "haptic_server/core/telemetry/tick_input.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/statistics/effect_statistics.h"

namespace bonemill {

// The states that the device went through in a run, and what stopped it.
struct DeviceChange {
    double t_s;  // since the session's first tick
    DeviceReport now;
};

class DeviceHistory {
  public:
    // A device that comes and goes without end fills neither memory nor log.
    static constexpr size_t kMaxKept = 256;

    // A run is taken to begin engaged. Reports come in the order of their ticks.
    void add(double t_s, const DeviceReport& report) {
        const bool is_same = report.state == last_.state && report.stop_cause == last_.stop_cause &&
                             report.fault_code == last_.fault_code;
        if (is_same) return;
        last_ = report;
        ++count_;
        if (kept_.size() < kMaxKept) kept_.push_back({t_s, report});
    }

    // The first kMaxKept changes, and how many there were in all.
    std::span<const DeviceChange> kept() const { return kept_; }
    uint64_t count() const { return count_; }

  private:
    DeviceReport last_;
    std::vector<DeviceChange> kept_;
    uint64_t count_ = 0;
};

// Says what has stopped the device: "too fast", "device fault 17"; empty if nothing has.
std::string causeText(const DeviceReport& report);
// Says it all for people: "protective stop: too fast. Hold the handle and reset."
std::string deviceText(const DeviceReport& report);

// The clients were shown this.
struct PublishFigures {
    LatencyHistogram rounds;  // each round of the publisher thread: encoding and all writes
    LatencyHistogram writes;  // of one node each
    uint32_t nodes = 0;       // at the end, as in the last Status
    uint64_t digest = 0;
};

class RunStatistics {
  public:
    // `period_ns` is the nominal time between ticks, > 0. `recorded` says what the records hold of effects.
    explicit RunStatistics(int64_t period_ns, const RecordedEffects& recorded = {})
        : period_ns_(period_ns), effects_(recorded) {}

    // Records come in the order of their ticks; those the ring dropped may be missing.
    void add(const TickRecord& record);
    // SpscRing::dropped() counts ticks that ran but are not in these statistics (their number still counts
    // in the rates).
    void setLostRecords(uint64_t lost_records) { lost_records_ = lost_records; }

    // These are the tick thread's after its first second; they are not known if never set.
    void setPageFaults(const PageFaults& faults) { page_faults_ = faults; }

    // It goes from the start of each tick that cut until its node meshes were with the publisher; it is not
    // known if never set.
    void setCutToPublisher(const LatencyHistogram& cut_to_publisher) { cut_to_publisher_ = cut_to_publisher; }

    // These are the publisher thread's after its last round; they are not known if never set.
    void setPublished(const PublishFigures& published) { published_ = published; }

    uint64_t ticks() const { return has_records_ ? last_tick_ - first_tick_ + 1 : 0; }
    double durationS() const;   // from the first to the last tick's start
    double meanRateHz() const;  // ticks per elapsed time; 0 with fewer than two ticks
    // There is one rate of every whole second since the first tick.
    const std::vector<double>& ratesHz() const { return rates_hz_; }
    // No tick started in so many periods of the schedule.
    uint64_t droppedTicks() const { return dropped_ticks_; }
    uint64_t lostRecords() const { return lost_records_; }

    // tickCompute lasts from the wake-up to the end of the tick's work.
    const LatencyHistogram& wakeupLatency() const { return wakeup_latency_; }
    const LatencyHistogram& tickCompute() const { return tick_compute_; }

    double meanContacts() const { return records_ ? double(contacts_sum_) / double(records_) : 0.0; }
    uint32_t maxContacts() const { return max_contacts_; }
    double maxForce() const { return max_force_; }              // N
    double maxTorque() const { return max_torque_; }            // N·m
    double maxPenetration() const { return max_penetration_; }  // m
    double removed() const { return removed_; }                 // m³
    double added() const { return added_; }                     // m³
    uint64_t removedVoxels() const { return removed_voxels_; }
    uint64_t addedVoxels() const { return added_voxels_; }
    const EffectStatistics& effects() const { return effects_; }
    const DeviceHistory& device() const { return device_; }
    uint32_t faults() const { return faults_; }  // every TickFault bit that was ever set

    // Makes one JSON object whose keys have unit suffixes. `materials` are the names of the scene's.
    std::string toJson(const std::vector<std::string>& materials = {}) const;
    // Throws UserError when the file cannot be written.
    void writeJson(const std::string& path, const std::vector<std::string>& materials = {}) const;

  private:
    void addSchedule(const TickRecord& record);
    void addFaults(uint32_t faults);

    int64_t period_ns_;
    bool has_records_ = false;
    uint64_t records_ = 0;
    uint64_t first_tick_ = 0;
    uint64_t last_tick_ = 0;
    int64_t first_start_ns_ = 0;
    int64_t last_start_ns_ = 0;
    int64_t last_due_ns_ = 0;
    uint64_t ticks_this_second_ = 0;
    std::vector<double> rates_hz_;
    uint64_t dropped_ticks_ = 0;
    uint64_t lost_records_ = 0;
    std::optional<PageFaults> page_faults_;
    std::optional<LatencyHistogram> cut_to_publisher_;
    std::optional<PublishFigures> published_;
    uint64_t cuts_ = 0;  // ticks that changed voxels
    LatencyHistogram wakeup_latency_;
    LatencyHistogram force_ready_;
    LatencyHistogram tick_compute_;
    uint64_t contacts_sum_ = 0;
    uint32_t max_contacts_ = 0;
    double max_force_ = 0.0;
    double max_torque_ = 0.0;
    double max_penetration_ = 0.0;
    double removed_ = 0.0;
    double added_ = 0.0;
    uint64_t removed_voxels_ = 0;
    uint64_t added_voxels_ = 0;
    EffectStatistics effects_;
    DeviceHistory device_;
    uint32_t faults_ = 0;
    std::array<uint64_t, 32> fault_ticks_{};
};

}  // namespace bonemill
