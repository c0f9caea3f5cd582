#include "device_daemon/app/loop_statistics.h"

#include <spdlog/fmt/fmt.h>

#include "common/rt/clock.h"
#include "common/units.h"

namespace bonemill {
namespace {

std::string quoted(const std::string& text) {
    std::string json = "\"";
    for (const char c : text) {  // control characters were refused when the scene was read
        if (c == '"' || c == '\\') json += '\\';
        json += c;
    }
    return json + '"';
}

std::string percentilesOf(const LatencyHistogram& histogram) {
    return fmt::format(R"({{"p50":{:.1f},"p99":{:.1f},"p99_9":{:.1f},"max":{:.1f}}})",
                       microsecondsOfNs(double(histogram.percentileNs(50))),
                       microsecondsOfNs(double(histogram.percentileNs(99))),
                       microsecondsOfNs(double(histogram.percentileNs(99.9))),
                       microsecondsOfNs(double(histogram.maxNs())));
}

}  // namespace

std::string jsonLineOf(const LoopStatistics& s) {
    const double rate_hz = s.wall_time > 0 ? s.ticks / s.wall_time : 0;
    return fmt::format(
        R"({{"ticks":{},"missed_periods":{},"wall_s":{:.3f},"scenario_s":{:.3f},"rate_hz":{:.2f},)"
        R"("wakeup_latency_us":{},"compute_us":{},"attached_ticks":{},"late_answers":{},)"
        R"("max_tracking_mm":{:.4f},"max_force_n":{:.4f},"max_torque_nmm":{:.3f},"clipped_ticks":{},)"
        R"("rate_limited_ticks":{},"stop_ticks":{},"failed_poses":{},"final_phase":{}}})",
        s.ticks, s.missed_periods, s.wall_time, s.scenario_time, rate_hz, percentilesOf(s.wakeup_latency),
        percentilesOf(s.compute_time), s.attached_ticks, s.late_answers,
        kPerMillimetre * s.max_tracking_error, s.max_force, kPerMilli * s.max_torque, s.clipped_ticks,
        s.rate_limited_ticks, s.stop_ticks, s.failed_poses, quoted(s.final_phase));
}

}  // namespace bonemill
