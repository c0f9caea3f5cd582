#include "device_daemon/apps/device_daemon/loop_statistics.h"

#include <spdlog/fmt/fmt.h>

#include "common/base/units.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

std::string percentilesOf(const LatencyHistogram& histogram) {
    return fmt::format(R"({{"p50":{:.1f},"p99":{:.1f},"p99_9":{:.1f},"max":{:.1f}}})",
                       microsecondsOfNs(double(histogram.percentileNs(50))),
                       microsecondsOfNs(double(histogram.percentileNs(99))),
                       microsecondsOfNs(double(histogram.percentileNs(99.9))),
                       microsecondsOfNs(double(histogram.maxNs())));
}

}  // namespace

std::string jsonLineOf(const LoopStatistics& s, const std::string& device_words) {
    const double rate_hz = s.wall_time > 0 ? double(s.ticks) / s.wall_time : 0;
    const bool is_object =
        device_words.size() > 1 && device_words.front() == '{' && device_words.back() == '}';
    return fmt::format(
        R"({{"ticks":{},"missed_periods":{},"wall_s":{:.3f},"rate_hz":{:.2f},"period_us":{},)"
        R"("wakeup_latency_us":{},"compute_us":{},"attached_ticks":{},"late_answers":{},"engaged_ticks":{},)"
        R"("max_force_n":{:.4f},"max_torque_nmm":{:.3f},"clamped_ticks":{},"rate_limited_ticks":{},)"
        R"("stops":{},"unheard_periods":{},"final_state":"{}"{}}})",
        s.ticks, s.missed_periods, s.wall_time, rate_hz, percentilesOf(s.period),
        percentilesOf(s.wakeup_latency), percentilesOf(s.compute_time), s.attached_ticks, s.late_answers,
        s.engaged_ticks, s.max_force, kPerMilli * s.max_torque, s.clamped_ticks, s.rate_limited_ticks,
        s.stops, s.unheard_periods, s.final_state, is_object ? ",\"device\":" + device_words : "");
}

}  // namespace bonemill
