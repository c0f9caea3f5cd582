#include "tests/bench/bench_loop.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <thread>

#include "common/config/user_error.h"
#include "common/rt/clock.h"
#include "common/rt/page_faults.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "haptic_server/tick/haptic_tick.h"
#include "haptic_server/tool/build/build_tool.h"
#include "haptic_server/volume/import/densify.h"
#include "haptic_server/volume/import/phantom/tooth_phantom.h"
#include "tests/bench/bench_output.h"

namespace bonemill::bench {
namespace {

constexpr int kLeafCells = 16;
constexpr double kMillSeconds = 14;  // down the corridor; then up again and once more beside it
const Eigen::Vector3d kTop(2.7e-3, -2.45e-3, 20.8e-3), kBottom(2.7e-3, -2.45e-3, 12.2e-3);
constexpr double kBeside = 0.15e-3;  // m: every pass finds new bone

struct Waits {
    LatencyHistogram wake_up;  // from the due instant to the first instruction
    LatencyHistogram compute;
    uint64_t ticks = 0, missed = 0;
    uint64_t missed_by_compute = 0;  // ticks longer than their period
};

// The device goes up and down, a little farther beside each time.
Pose deviceAt(double t) {
    const double cycle = t / kMillSeconds, down = cycle - std::floor(cycle);
    const Eigen::Vector3d aside(kBeside * std::floor(cycle), kBeside * std::sin(20 * t), 0);
    return {kTop + aside + (kBottom - kTop) * std::sin(M_PI * down),
            Eigen::Quaterniond(M_SQRT1_2, M_SQRT1_2, 0, 0)};
}

class TimedIo final : public TickIo {
  public:
    TimedIo(int64_t period_ns, double seconds, Waits& waits)
        : timer_(period_ns, monotonicNowNs()),
          period_ns_(period_ns),
          end_ns_(monotonicNowNs() + int64_t(seconds * 1e9)),
          waits_(waits) {}

    bool read(DeviceInput& input) noexcept override {
        const int64_t due = timer_.waitNext();
        start_ns_ = monotonicNowNs();
        if (first_ns_ == 0) first_ns_ = start_ns_;
        input.t_s = double(start_ns_ - first_ns_) * 1e-9;
        input.X_WT_device = deviceAt(input.t_s);
        input.buttons = kButtonRemove;
        input.start_ns = start_ns_;
        input.wakeup_latency_ns = start_ns_ - due;
        waits_.wake_up.record(start_ns_ - due);
        ++waits_.ticks;
        return start_ns_ < end_ns_;
    }
    int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
    int64_t now() noexcept override { return monotonicNowNs(); }
    void push(const TickRecord& record) noexcept override {
        waits_.compute.record(record.compute_ns);
        waits_.missed_by_compute += record.compute_ns > period_ns_;
        waits_.missed = timer_.missedPeriods();
    }

  private:
    PeriodicTimer timer_;
    int64_t period_ns_, end_ns_, start_ns_ = 0, first_ns_ = 0;
    Waits& waits_;
};

// On a thread of its own with the tick's priority. Says what the machine does not grant.
RealtimeReport inRealTime(const std::function<void()>& work) {
    RealtimeReport report;
    std::thread([&] {
        report = makeThreadRealtime({.core = int(std::thread::hardware_concurrency()) - 1});
        work();
    }).join();
    return report;
}

nlohmann::json toJson(const Waits& waits) {
    return {{"ticks", waits.ticks},
            {"missed", waits.missed},
            {"missed_by_compute", waits.missed_by_compute},
            {"wake_up_us", microseconds(waits.wake_up)},
            {"compute_us", microseconds(waits.compute)}};
}

void run(double rate_hz, double seconds, const std::string& json_path) {
    const int64_t period_ns = std::llround(1e9 / rate_hz);
    BoneModel bone(densify(scanTooth(toothGrid(), {}), DensityWindow{-1000, 3000, 600, 0}),
                   Eigen::Vector3i::Constant(kLeafCells), {.levels = {{1, ShellNormals::kTrilinear}}});
    const ToolModel tool = buildTool({}).model;
    TickConfig config;
    config.dt = 1 / rate_hz;
    HapticTick tick(config, bone, tool, nullptr);
    RealtimeReport report = lockMemory();
    Waits bare, loop;
    report.append(inRealTime([&] {
        PeriodicTimer timer(period_ns, monotonicNowNs());
        const int64_t end = monotonicNowNs() + int64_t(seconds * 1e9);
        for (int64_t due = 0; due < end; ++bare.ticks) {
            due = timer.waitNext();
            bare.wake_up.record(monotonicNowNs() - due);
        }
        bare.missed = timer.missedPeriods();
    }));
    PageFaults before, after;
    inRealTime([&] {
        TimedIo io(period_ns, seconds, loop);
        before = pageFaultsOf(gettid()).value_or(PageFaults{});
        while (tick.tick(io)) {
        }
        after = pageFaultsOf(gettid()).value_or(PageFaults{});
    });
    for (const std::string& missing : report.missing) std::printf("not granted: %s\n", missing.c_str());
    Table table({"us", "mean", "p50", "p99", "p99.9", "max"});
    table.add({"bare timer, wake-up"}, bare.wake_up);
    table.add({"loop, wake-up"}, loop.wake_up);
    table.add({"loop, compute"}, loop.compute);
    table.print();
    std::printf("periods missed: bare timer %llu of %llu; loop %llu of %llu, %llu of them by its own work\n",
                (unsigned long long)bare.missed, (unsigned long long)bare.ticks,
                (unsigned long long)loop.missed, (unsigned long long)loop.ticks,
                (unsigned long long)loop.missed_by_compute);
    std::printf("page faults of the loop: %llu minor, %llu major\n",
                (unsigned long long)(after.minor - before.minor),
                (unsigned long long)(after.major - before.major));
    writeJson(json_path, {{"bare", toJson(bare)},
                          {"loop", toJson(loop)},
                          {"page_faults",
                           {{"minor", after.minor - before.minor}, {"major", after.major - before.major}}}});
}

}  // namespace

void addLoopCommand(CLI::App& app) {
    struct Options {
        double rate_hz = 4000, seconds = 60;
        std::string json;
    };
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("loop", "the tooth's corridor in real time, beside a bare timer");
    command->add_option("--rate-hz", o->rate_hz)->check(CLI::Range(100.0, 20000.0));
    command->add_option("--seconds", o->seconds, "of each of the two")->check(CLI::Range(1.0, 3600.0));
    command->add_option("--json", o->json, "write the figures to FILE, or - for stdout");
    command->callback([o] { run(o->rate_hz, o->seconds, o->json); });
}

}  // namespace bonemill::bench
