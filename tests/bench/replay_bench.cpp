// Makes a recording of any length and measures what a replay of it takes: loading it, the wait of jumps in
// it, and how fast its ticks run again. It asserts nothing.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>

#include "common/process/run_program.h"
#include "common/rt/clock.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/server/replay/survey.h"
#include "tests/bench/processor_time.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::bench {
namespace {

double secondsSince(int64_t start_ns) {
    return secondsOfNs(monotonicNowNs() - start_ns);
}

void run(double minutes, int jumps) {
    const test::TemporaryFolder folder;
    const auto ticks = uint64_t(minutes * 60'000);
    const test::RecordedSession session =
        test::recordSession(folder.path(), {.ticks = ticks, .has_orders = false});
    std::printf("%.1f min, %llu ticks, %.1f MB in the file, %.1f bytes per tick\n", minutes,
                (unsigned long long)ticks, double(std::filesystem::file_size(session.journal)) / 1e6,
                double(std::filesystem::file_size(session.journal)) / double(ticks));
    const int64_t load_ns = monotonicNowNs();
    const Recording recording(session.journal);
    const LoadedScene scene = recording.scene();
    const SceneSetup simulation = setUpScene(scene);
    const Recording::Bones bones = recording.readBones(*simulation.bone);
    std::printf("loaded in %.2f s, %zu states of the bone, %.0f MB of memory in all\n", secondsSince(load_ns),
                bones.keyframes.size(), double(residentBytesOf(getpid())) / 1e6);

    Rerun rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front());
    const Keyframes keyframes(bones.keyframes);
    std::mt19937_64 random(7);
    std::vector<double> waits_s;
    for (int n = 0; n < jumps; ++n) {
        const uint64_t to = random() % ticks;
        const int64_t start_ns = monotonicNowNs();
        rerun.startAt(keyframes.before(to));
        while (rerun.next() <= to) rerun.step();
        waits_s.push_back(secondsSince(start_ns));
    }
    std::ranges::sort(waits_s);
    std::printf("%d jumps: median %.3f s, 95 %% %.3f s, max %.3f s\n", jumps, waits_s[waits_s.size() / 2],
                waits_s[waits_s.size() * 95 / 100], waits_s.back());

    rerun.startAt(bones.keyframes.front());
    const double before_s = processorSeconds(getpid());
    const uint64_t count = std::min<uint64_t>(ticks, 60'000);
    while (rerun.next() < count) rerun.step();
    const double used_s = processorSeconds(getpid()) - before_s;
    std::printf("%llu ticks again in %.2f s of processor time: %.1f times real time\n",
                (unsigned long long)count, used_s, double(count) / 1000 / used_s);
}

}  // namespace
}  // namespace bonemill::bench

int main(int argc, char** argv) {
    CLI::App app("what a replay takes", "replay_bench");
    double minutes = 1;
    int jumps = 50;
    app.add_option("--minutes", minutes, "length of the recording")->capture_default_str();
    app.add_option("--jumps", jumps, "random ones")->check(CLI::Range(1, 10000))->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return bonemill::runProgram([&] {
        bonemill::bench::run(minutes, jumps);
        return 0;
    });
}
