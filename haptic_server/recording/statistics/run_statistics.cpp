#include "haptic_server/recording/statistics/run_statistics.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/text/hex_text.h"
#include "haptic_server/core/telemetry/fault_names.h"

namespace bonemill {
namespace {

// This instant should have woken the tick: late wake-ups are latency, not gaps in the schedule.
int64_t dueNs(const TickRecord& record) {
    return record.start_ns - record.wakeup_latency_ns;
}

double norm(const double (&v)[3]) {
    return std::hypot(v[0], v[1], v[2]);
}

nlohmann::ordered_json summary(const LatencyHistogram& histogram, double ns_per_unit) {
    return {{"p50", double(histogram.percentileNs(50)) / ns_per_unit},
            {"p99", double(histogram.percentileNs(99)) / ns_per_unit},
            {"p99_9", double(histogram.percentileNs(99.9)) / ns_per_unit},
            {"max", double(histogram.maxNs()) / ns_per_unit},
            {"mean", histogram.meanNs() / ns_per_unit}};
}

nlohmann::ordered_json summaryUs(const LatencyHistogram& histogram) {
    return summary(histogram, double(kNsPerMicrosecond));
}

nlohmann::ordered_json changesOf(const DeviceHistory& device) {
    nlohmann::ordered_json changes = nlohmann::ordered_json::array();
    for (const DeviceChange& change : device.kept()) {
        changes.push_back({{"t_s", change.t_s}, {"state", nameOf(SafetyState(change.now.state))}});
        if (change.now.stop_cause == uint32_t(StopCause::kNone)) continue;
        changes.back()["cause"] = causeText(change.now);
        changes.back()["what_to_do"] = whatToDo(StopCause(change.now.stop_cause));
    }
    return changes;
}

// The figures that people read, with words and unit.
nlohmann::ordered_json wordsOf(const EffectStatistics& effects) {
    nlohmann::ordered_json words = nlohmann::ordered_json::array();
    for (const auto& [figure, value] : effects.figures())
        if (figure->run.words)
            words.push_back({{"words", figure->run.words},
                             {"value", figure->shown.factor * value},
                             {"unit", figure->shown.unit}});
    return words;
}

}  // namespace

std::string causeText(const DeviceReport& report) {
    const auto cause = StopCause(report.stop_cause);
    if (cause == StopCause::kNone) return "";
    const std::string text = nameOf(cause);
    return cause == StopCause::kDeviceFault ? text + " " + std::to_string(report.fault_code) : text;
}

std::string deviceText(const DeviceReport& report) {
    const std::string text = nameOf(SafetyState(report.state)), cause = causeText(report);
    return cause.empty() ? text : text + ": " + cause + ". " + whatToDo(StopCause(report.stop_cause));
}

void RunStatistics::add(const TickRecord& record) {
    addSchedule(record);
    ++records_;
    wakeup_latency_.record(record.wakeup_latency_ns);
    force_ready_.record(record.force_ns);
    tick_compute_.record(record.compute_ns);
    contacts_sum_ += record.contacts;
    max_contacts_ = std::max(max_contacts_, record.contacts);
    max_force_ = std::max(max_force_, norm(record.f_hand_W));
    max_torque_ = std::max(max_torque_, norm(record.t_hand_W));
    max_penetration_ = std::max(max_penetration_, record.max_penetration);
    removed_ += record.removed;
    added_ += record.added;
    removed_voxels_ += record.removed_voxels;
    added_voxels_ += record.added_voxels;
    cuts_ += !record.cut.isEmpty();
    if (effects_.recorded().any()) effects_.add(record.effects);
    device_.add(record.t_s, record.device);
    addFaults(record.faults);
}

void RunStatistics::addSchedule(const TickRecord& record) {
    if (!has_records_) {
        has_records_ = true;
        first_tick_ = record.tick;
        first_start_ns_ = record.start_ns;
        ticks_this_second_ = 1;
    } else {
        const uint64_t ticks = record.tick - last_tick_;  // more than 1 after lost records
        const double periods = std::round(double(dueNs(record) - last_due_ns_) / double(period_ns_));
        if (periods > double(ticks)) dropped_ticks_ += uint64_t(periods) - ticks;
        const auto second = size_t(std::max<int64_t>(record.start_ns - first_start_ns_, 0) / kNsPerSecond);
        while (rates_hz_.size() < second) {
            rates_hz_.push_back(double(ticks_this_second_));
            ticks_this_second_ = 0;
        }
        ticks_this_second_ += ticks;
    }
    last_tick_ = record.tick;
    last_start_ns_ = record.start_ns;
    last_due_ns_ = dueNs(record);
}

void RunStatistics::addFaults(uint32_t faults) {
    faults_ |= faults;
    for (size_t bit = 0; bit < fault_ticks_.size(); ++bit) fault_ticks_[bit] += faults >> bit & 1u;
}

double RunStatistics::durationS() const {
    return secondsOfNs(last_start_ns_ - first_start_ns_);
}

double RunStatistics::meanRateHz() const {
    return durationS() > 0.0 ? double(last_tick_ - first_tick_) / durationS() : 0.0;
}

std::string RunStatistics::toJson(const std::vector<std::string>& materials) const {
    nlohmann::ordered_json faults = nlohmann::ordered_json::object();
    for (size_t bit = 0; bit < fault_ticks_.size(); ++bit) {
        if (fault_ticks_[bit] > 0) faults[faultNames(1u << bit)] = fault_ticks_[bit];
    }
    const auto slowest = std::min_element(rates_hz_.begin(), rates_hz_.end());
    nlohmann::ordered_json report = {
        {"ticks", ticks()},
        {"duration_s", durationS()},
        {"nominal_rate_hz", double(kNsPerSecond) / double(period_ns_)},
        {"mean_rate_hz", meanRateHz()},
        {"slowest_second_hz", slowest == rates_hz_.end() ? meanRateHz() : *slowest},
        {"rates_hz", rates_hz_},
        {"dropped_ticks", dropped_ticks_},
        {"lost_records", lost_records_},
        {"wakeup_latency_us", summaryUs(wakeup_latency_)},
        {"force_ready_us", summaryUs(force_ready_)},
        {"tick_compute_us", summaryUs(tick_compute_)},
        {"contacts_mean", meanContacts()},
        {"contacts_max", max_contacts_},
        {"force_max_n", max_force_},
        {"torque_max_nm", max_torque_},
        {"penetration_max_mm", max_penetration_ * kPerMillimetre},
        {"removed_mm3", removed_ * kPerCubicMillimetre},
        {"removed_voxels", removed_voxels_},
        {"added_mm3", added_ * kPerCubicMillimetre},
        {"added_voxels", added_voxels_},
        {"cuts", cuts_},
        {"fault_ticks", faults},
    };
    if (device_.count() > 0) {
        report["device_changes"] = device_.count();
        report["device_states"] = changesOf(device_);
    }
    for (const auto& [figure, value] : effects_.figures()) report[figure->run.key] = value;
    if (effects_.recorded().any()) report["effects"] = wordsOf(effects_);
    if (effects_.recorded().any()) report["warnings"] = effects_.warnings(materials);
    if (page_faults_)
        report["page_faults_after_warm_up"] = {{"minor", page_faults_->minor},
                                               {"major", page_faults_->major}};
    if (cut_to_publisher_) {
        report["cut_to_publisher_ms"] = summary(*cut_to_publisher_, double(kNsPerMillisecond));
        report["cuts_at_publisher"] = cut_to_publisher_->count();
    }
    if (published_) {
        report["publish_round_ms"] = summary(published_->rounds, double(kNsPerMillisecond));
        report["node_write_ms"] = summary(published_->writes, double(kNsPerMillisecond));
        report["published_nodes"] = published_->nodes;
        report["published_digest"] = hexText(published_->digest);
    }
    return report.dump(2);
}

void RunStatistics::writeJson(const std::string& path, const std::vector<std::string>& materials) const {
    std::ofstream file(path);
    file << toJson(materials) << '\n';
    file.close();
    if (!file) throw UserError("report " + path + " cannot be written (" + std::strerror(errno) + ")");
}

}  // namespace bonemill
