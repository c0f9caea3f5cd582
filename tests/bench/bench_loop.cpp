#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "common/rt/clock.h"
#include "common/rt/realtime.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/corridor_run.h"
#include "tests/bench/leaf_cells.h"

namespace bonemill::bench {
namespace {

void run(double rate_hz, double seconds, const std::string& json_path) {
    const int64_t period_ns = std::llround(double(kNsPerSecond) / rate_hz);
    BoneModel bone = corridorBone(kLeafCells);
    const ToolModel tool = buildTool({}).model;
    FixedTick tick({corridorTick(rate_hz), {&tool}, {}}, bone);
    RealtimeReport report = lockMemory();
    Waits bare, loop;
    report.append(inRealTime([&] {
        PeriodicTimer timer(period_ns, monotonicNowNs());
        const int64_t end = monotonicNowNs() + int64_t(seconds * double(kNsPerSecond));
        for (int64_t due = 0; due < end; ++bare.ticks) {
            due = timer.waitNext();
            bare.wake_up.record(monotonicNowNs() - due);
        }
        bare.missed = timer.missedPeriods();
    }));
    PageFaults before, after;
    inRealTime([&] {
        CorridorIo io(period_ns, seconds, loop);
        before = pageFaultsOf(gettid()).value_or(PageFaults{});
        io.lead(tick, [](const TickRecord&) {});
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
    std::printf("faults of the loop: %s\n", faultNames(loop.faults).c_str());
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
    addJsonOption(*command, o->json);
    command->callback([o] { run(o->rate_hz, o->seconds, o->json); });
}

}  // namespace bonemill::bench
