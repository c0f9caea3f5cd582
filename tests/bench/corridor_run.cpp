#include "tests/bench/corridor_run.h"

#include <cmath>
#include <thread>

#include "common/rt/clock.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "tests/bench/bench_output.h"
#include "tests/support/typical_effects.h"
#include "tests/support/whole_densities.h"

namespace bonemill::bench {
namespace {

constexpr double kMillSeconds = 14;  // down the corridor; then up again and once more beside it
const Eigen::Vector3d kTop(2.7e-3, -2.45e-3, 20.8e-3), kBottom(2.7e-3, -2.45e-3, 12.2e-3);
constexpr double kBeside = 0.15e-3;  // m: every pass finds new bone

Pose deviceAt(double t) {
    const double cycle = t / kMillSeconds, down = cycle - std::floor(cycle);
    const Eigen::Vector3d aside(kBeside * std::floor(cycle), kBeside * std::sin(20 * t), 0);
    return {kTop + aside + (kBottom - kTop) * std::sin(M_PI * down),
            Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0, 0)};
}

}  // namespace

nlohmann::json toJson(const Waits& waits) {
    return {{"ticks", waits.ticks},
            {"missed", waits.missed},
            {"missed_by_compute", waits.missed_by_compute},
            {"wake_up_us", microseconds(waits.wake_up)},
            {"compute_us", microseconds(waits.compute)},
            {"faults", waits.faults},
            {"fault_names", faultNames(waits.faults)}};
}

BoneModel corridorBone(int leaf_cells) {
    VoxelVolume volume = densify(scanTooth(toothGrid(), {}), DensityWindow{-1000, 3000, 600});
    clearFarFromBone(volume);
    return {std::move(volume),
            Eigen::Vector3i::Constant(leaf_cells),
            {.levels = {{1, ShellNormals::kTrilinear}}}};
}

TickConfig corridorTick(double rate_hz) {
    TickConfig config;
    config.dt = 1 / rate_hz;
    config.effects.time_removal = test::kTimeRemoval;
    TickBudget::apply(config.dt, config.gradient, config.most_milled_cells);
    return config;
}

CorridorIo::CorridorIo(int64_t period_ns, double seconds, Waits& waits)
    : timer_(period_ns, monotonicNowNs()),
      period_ns_(period_ns),
      end_ns_(monotonicNowNs() + int64_t(seconds * double(kNsPerSecond))),
      waits_(waits) {}

bool CorridorIo::read(DeviceInput& input) noexcept {
    const int64_t due = timer_.waitNext();
    start_ns_ = monotonicNowNs();
    if (first_ns_ == 0) first_ns_ = start_ns_;
    input.t_s = secondsOfNs(start_ns_ - first_ns_);
    input.X_WT_device = deviceAt(input.t_s);
    input.buttons = kButtonRemove;
    input.start_ns = start_ns_;
    input.deadline_ns = start_ns_ + period_ns_;
    input.wakeup_latency_ns = start_ns_ - due;
    waits_.wake_up.record(start_ns_ - due);
    ++waits_.ticks;
    return start_ns_ < end_ns_;
}

int64_t CorridorIo::write(const Wrench&) noexcept {
    return monotonicNowNs();
}

int64_t CorridorIo::now() noexcept {
    return monotonicNowNs();
}

void CorridorIo::note(const TickRecord& record) noexcept {
    waits_.compute.record(record.compute_ns);
    waits_.missed_by_compute += record.compute_ns > period_ns_;
    waits_.missed = timer_.missedPeriods();
    waits_.faults |= record.faults;
}

RealtimeReport inRealTime(const std::function<void()>& work) {
    RealtimeReport report;
    std::thread([&] {
        report = makeThreadRealtime({.core = coreFromLast(0)});
        work();
    }).join();
    return report;
}

}  // namespace bonemill::bench
