#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "common/mesh_codec/mesh_codec.h"
#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/bench/bench_commands.h"
#include "tests/bench/bench_output.h"
#include "tests/bench/corridor_run.h"

namespace bonemill::bench {
namespace {

using namespace std::chrono_literals;

constexpr size_t kRingCuts = 8192;
constexpr auto kPublishPeriod = 10ms;
constexpr int64_t kAllBytes = INT64_MAX;

struct RemeshOptions {
    double rate_hz = 1000, seconds = 30;
    int leaf_cells = 16;
    std::string json;
};

struct Remeshing {
    Waits tick;
    LatencyHistogram cut_to_publisher;
    double mesher_share = 0;  // of one core's time
    uint64_t dropped_cuts = 0;
    uint64_t meshed = 0;     // meshes that the mesher handed over
    uint64_t published = 0;  // of these, those that a newer one did not replace
    RealtimeReport report;
};

double threadCpuSeconds() {
    timespec used;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return double(used.tv_sec) + secondsOfNs(used.tv_nsec);
}

// Does what the mesher thread of the server does. Returns the processor time that it took, s.
double meshWhile(const std::atomic<bool>& is_running, MeshRounds& rounds, const MeshRounds::Sink& put) {
    while (is_running) {
        while (rounds.round(put)) {
        }
        std::this_thread::sleep_for(MeshRounds::kPeriod);
    }
    return threadCpuSeconds();
}

// Does what the publisher thread of the server does, without the network.
void publishWhile(const std::atomic<bool>& is_running, MeshOutbox& outbox, uint64_t& published) {
    while (is_running) {
        for (const NodeGroup& group :
             outbox.takeNearest(Eigen::Vector3f::Zero(), kAllBytes, monotonicNowNs()))
            for (const NodeMesh& mesh : group.meshes) {
                encodeNodeMesh(mesh, {});
                ++published;
            }
        std::this_thread::sleep_for(kPublishPeriod);
    }
}

Remeshing millBesideMesher(const RemeshOptions& o) {
    Remeshing result;
    BoneModel bone = corridorBone(o.leaf_cells);
    const ToolModel tool = buildTool({}).model;
    FixedTick tick({corridorTick(o.rate_hz), {&tool}, {}}, bone);
    SpscRing<Cut> cuts(kRingCuts);
    MeshOutbox outbox;
    MeshRounds rounds(bone.volume, bone.lattice, cuts);
    while (!rounds.hasMeshedAll()) rounds.round([](NodeGroup&&) {});
    const auto put = [&](NodeGroup&& group) {
        result.meshed += group.meshes.size();
        outbox.put(std::move(group), monotonicNowNs());
    };
    result.report = lockMemory();
    std::atomic<bool> is_running{true};
    std::jthread mesher([&] { result.mesher_share = meshWhile(is_running, rounds, put) / o.seconds; });
    std::jthread publisher([&] { publishWhile(is_running, outbox, result.published); });
    result.report.append(inRealTime([&] {
        CorridorIo io(std::llround(double(kNsPerSecond) / o.rate_hz), o.seconds, result.tick);
        io.lead(tick, [&cuts](const TickRecord& record) { tellMesher(cuts, record.cut); });
    }));
    is_running = false;
    mesher.join();
    publisher.join();
    result.cut_to_publisher = rounds.cutToSink();
    result.dropped_cuts = cuts.dropped();
    return result;
}

void run(const RemeshOptions& o) {
    const Remeshing result = millBesideMesher(o);
    for (const std::string& missing : result.report.missing)
        std::printf("not granted: %s\n", missing.c_str());
    Table table({"us", "mean", "p50", "p99", "p99.9", "max"});
    table.add({"cut to publisher"}, result.cut_to_publisher);
    table.add({"tick, wake-up"}, result.tick.wake_up);
    table.add({"tick, compute"}, result.tick.compute);
    table.print();
    std::printf("faults of the tick: %s\n", faultNames(result.tick.faults).c_str());
    std::printf("mesher: %.0f %% of a core\n", 100 * result.mesher_share);
    std::printf("%llu cuts measured, %llu dropped; %llu meshes, %llu of them published\n",
                (unsigned long long)result.cut_to_publisher.count(), (unsigned long long)result.dropped_cuts,
                (unsigned long long)result.meshed, (unsigned long long)result.published);
    writeJson(o.json, {{"cut_to_publisher_us", microseconds(result.cut_to_publisher)},
                       {"cuts_measured", result.cut_to_publisher.count()},
                       {"cuts_dropped", result.dropped_cuts},
                       {"mesher_share", result.mesher_share},
                       {"meshes", result.meshed},
                       {"meshes_published", result.published},
                       {"tick", toJson(result.tick)}});
}

}  // namespace

void addRemeshCommand(CLI::App& app) {
    auto o = std::make_shared<RemeshOptions>();
    CLI::App* command = app.add_subcommand(
        "remesh", "the tooth's corridor in real time beside the mesher: from cut to publisher");
    command->add_option("--rate-hz", o->rate_hz)->check(CLI::Range(100.0, 20000.0));
    command->add_option("--seconds", o->seconds)->check(CLI::Range(1.0, 3600.0));
    command->add_option("--leaf-cells", o->leaf_cells, "cells per edge of a leaf")->check(CLI::Range(4, 128));
    addJsonOption(*command, o->json);
    command->callback([o] { run(*o); });
}

}  // namespace bonemill::bench
