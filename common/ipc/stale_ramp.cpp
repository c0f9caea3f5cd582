#include "common/ipc/stale_ramp.h"

#include <algorithm>

namespace bonemill {
namespace {

double smoothStep(double u) noexcept {
    return u * u * (3.0 - 2.0 * u);
}

double progress(int64_t now_ns, int64_t start_ns, int64_t duration_ns) noexcept {
    if (duration_ns <= 0) return 1.0;
    return std::clamp((double(now_ns) - double(start_ns)) / double(duration_ns), 0.0, 1.0);
}

}  // namespace

double StaleRamp::update(int64_t now_ns, int64_t newest_stamp_ns) noexcept {
    // The stamps are compared without their difference, which garbage could make overflow.
    const bool is_too_old = newest_stamp_ns <= now_ns - config_.stale_after_ns;
    const bool is_stale = is_too_old || newest_stamp_ns > now_ns + config_.stale_after_ns;
    if (is_stale != is_stale_) {
        is_stale_ = is_stale;
        factor_at_start_ = factor_;
        // Silence began when the stamp grew too old: maybe some time before this call, but after
        // the last one.
        const int64_t too_old_at_ns = is_too_old ? newest_stamp_ns + config_.stale_after_ns : now_ns;
        ramp_start_ns_ = is_stale ? std::clamp(too_old_at_ns, std::min(updated_ns_, now_ns), now_ns) : now_ns;
    }
    updated_ns_ = now_ns;
    if (is_stale_) {
        factor_ = std::max(0.0, factor_at_start_ - progress(now_ns, ramp_start_ns_, config_.ramp_down_ns));
    } else {
        const double u = progress(now_ns, ramp_start_ns_, config_.ramp_up_ns);
        factor_ = factor_at_start_ + (1.0 - factor_at_start_) * smoothStep(u);
    }
    return factor_;
}

}  // namespace bonemill
