// Closes the loop live: ares_emulator, device_daemon and haptic_server, over UDP and shared memory. A tool
// that is pressed on bone must come to rest, as in the stability suite's simulated time
// (docs/explanation/stability.md).
//
// The device has no dry friction: with the usual 0.2 N the handle sticks even where the loop would shake.
//
// Only what the session recorded is judged. A busy machine lets processes pause, which moves the handle, or
// stops the device as late; what else stops it, and what goes on in most windows of the rest, is the loop's
// own. Silence is taken for such only after 200 ms. A session with every tenth tick late is none at all: the
// machine has changed the loop. A loop that shakes does so in every session, a disturbed one in some.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <sstream>

#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/integration/device/live_loop_trace.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;
using test::Process;

constexpr double kQuietForce = 0.05;        // N RMS, as in the stability suite
constexpr double kQuietHand = 10e-6;        // m RMS: two steps of the encoders
constexpr double kSettle = 0.5;             // s, as in the stability suite
constexpr double kTop = 2e-3;               // m, the slab's upper face
constexpr double kVoxel = 0.125e-3;         // m
constexpr double kBurr = 1e-3;              // m, its radius
constexpr double kContactStiffness = 1e12;  // N/m³, of a scene that says nothing
constexpr size_t kEnoughWindows = 8;        // of the rest
constexpr int kMaxSessions = 5;             // until a busy machine leaves enough of them
constexpr double kMaxLate = 0.1;            // of the ticks
constexpr uint32_t kUnstable =
    kFaultBadDevicePose | kFaultSolve | kFaultForceClamped | kFaultStalled | kFaultImplausibleDevice;

constexpr const char* kTooBusy = "the machine is too busy to run the loop in time";

struct LiveScene {
    std::string more;  // of the scene file
    std::string waypoints;
    double rest_after;  // s of the scenario, when the hand wants to move no more
};

std::string waypoint(double time, const char* p_WT_mm, const char* more = "") {
    std::ostringstream text;
    text << "waypoint { time_s: " << time << " p_WT_mm { " << p_WT_mm
         << " } q_WT { w: 0.70710678 x: 0.70710678 } " << more << " }\n";
    return text.str();
}

// The hand comes from above and presses the burr with some 2.5 N on the slab's face.
LiveScene wallPress(const std::string& more = "") {
    return {.more = more,
            .waypoints = waypoint(0, "y: 0.1 z: 3.5") + waypoint(0.4, "x: 0.4 y: 0.1 z: -2") +
                         waypoint(2.4, "x: 0.4 y: 0.1 z: -2"),
            .rest_after = 0.4};
}

// The burr mills a corridor of 2.5 mm into the slab, stops milling, and is pulled against its wall.
LiveScene corridor() {
    return {.more = "effects { time_removal {} }",
            .waypoints = waypoint(0, "y: 0.1 z: 3.5", "remove: true") + waypoint(1.5, "y: 0.1 z: 0.5") +
                         waypoint(1.6, "y: 0.1 z: 0.5") + waypoint(2, "x: 5 y: 0.1 z: 0.5") +
                         waypoint(4, "x: 5 y: 0.1 z: 0.5"),
            .rest_after = 2};
}

struct LiveRun {
    test::RestFigures rest;
    std::vector<std::string> causes;  // of all stops
    uint32_t faults = 0;              // of all ticks
    double late_share = 0;            // of the ticks, while engaged

    bool isInTime() const { return late_share <= kMaxLate; }
    bool hasRest() const { return isInTime() && rest.windows >= kEnoughWindows; }
    bool isQuiet() const { return hasRest() && rest.force_rms <= kQuietForce && rest.hand_rms <= kQuietHand; }
};

class LiveLoop : public testing::Test {
  protected:
    LiveLoop() {
        const auto made = test::run({"make_phantom", "body", "--kind", "slab", "--voxel-mm", "0.125",
                                     "--dims", "64", "64", "64", "--out", folder_ / "slab.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
    }

    // One session, until the hand has gone its way; what keeps it from that does not wait for ever.
    LiveRun session(const LiveScene& scene) {
        const std::string file = folder_ / "s.textproto", session = std::to_string(testSession());
        test::writeFile(file, "name: \"live\" volume { path: \"slab.nrrd\" } loop { stale_after_ms: 200 }\n" +
                                  scene.more +
                                  "\ndevice { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: "
                                  "0.70710678 } coulomb_friction_n: 0 }\nsimulated_operator {\n" +
                                  scene.waypoints + "}\n");
        Process server({"haptic_server", "--scene", file, "--session", session, "--domain",
                        std::to_string(testDomain()), "--trace", folder_ / "trace.csv", "--report",
                        folder_ / "report.json", "--until-device-leaves"});
        Process daemon({"device_daemon", "--device", "simulated", "--scene", file, "--session", session,
                        "--stop-dir", folder_ / "stops"});
        test::waitFor([&] { return !daemon.isRunning(); }, 30s);
        if (daemon.isRunning()) daemon.signal(SIGTERM);
        const test::Finished hand = daemon.wait(), felt = server.wait();
        EXPECT_EQ(hand.exit_code, 0) << hand.err;
        EXPECT_EQ(felt.exit_code, 0) << felt.err;
        return felt.exit_code == 0 ? recorded(scene.rest_after) : LiveRun{};
    }

    // The machine may be too busy for what is wanted of a session, but not every time.
    LiveRun sessionWith(bool (LiveRun::*is_wanted)() const, const LiveScene& scene) {
        LiveRun run;
        for (int i = 0; i < kMaxSessions && !(run.*is_wanted)() && !HasFailure(); ++i) run = session(scene);
        return run;
    }
    LiveRun quietSession(const LiveScene& scene) { return sessionWith(&LiveRun::isQuiet, scene); }

  private:
    LiveRun recorded(double rest_after) {
        LiveRun run;
        const auto rows = test::liveRowsOf(test::readFile(folder_ / "trace.csv"));
        const auto report = nlohmann::json::parse(test::readFile(folder_ / "report.json"));
        // A hand that was interrupted comes back another way.
        if (const auto first = test::firstEngagementOf(report, rows.empty() ? 0 : rows.back().t)) {
            run.rest = test::restFiguresOf(rows, first->begin + rest_after + kSettle, first->end);
            run.late_share = test::lateShareOf(rows, *first);
        }
        run.causes = test::causesOf(report);
        for (const test::LiveRow& row : rows) run.faults |= row.faults;
        std::cout << "at rest in " << run.rest.windows << " windows: " << run.rest.force_rms
                  << " N RMS about " << run.rest.force.transpose() << " N, hand " << run.rest.hand_rms * 1e6
                  << " um RMS, tool at " << run.rest.p_tool.transpose() * 1e3 << " mm, "
                  << run.rest.penetration * 1e6 << " um deep; " << run.causes.size() << " stops, faults "
                  << run.faults << ", " << 100 * run.late_share << " % late\n";
        return run;
    }

    test::TemporaryFolder folder_;
};

// Of what stops a device, only this may be the machine's doing.
bool isTheLoopsOwn(const std::string& cause) {
    return cause != "packets come late" && cause != "device lost";
}

bool isStoppedByItself(const LiveRun& run) {
    return std::any_of(run.causes.begin(), run.causes.end(), isTheLoopsOwn);
}

void expectStable(const LiveRun& run) {
    for (const std::string& cause : run.causes) EXPECT_FALSE(isTheLoopsOwn(cause)) << cause;
    EXPECT_EQ(run.faults & kUnstable, 0u);
    ASSERT_TRUE(run.hasRest()) << "there was no rest to judge";
    EXPECT_LE(run.rest.force_rms, kQuietForce);
    EXPECT_LE(run.rest.hand_rms, kQuietHand);
}

TEST_F(LiveLoop, ABurrPressedOnAWallComesToRest) {
    const LiveRun run = quietSession(wallPress());
    if (!run.isInTime()) GTEST_SKIP() << kTooBusy;
    expectStable(run);
    const double force = run.rest.force.z();
    EXPECT_GT(force, 1) << "it must press, and be felt";
    const double depth = std::sqrt(force / (std::numbers::pi * kContactStiffness * kBurr));
    EXPECT_NEAR(run.rest.p_tool.z(), kTop + kBurr - depth, 3e-6) << "it is as deep as its force says";
    EXPECT_NEAR(run.rest.penetration, depth, 3e-6);
}

TEST_F(LiveLoop, ABurrPulledAgainstTheWallOfItsCorridorComesToRest) {
    const LiveRun run = quietSession(corridor());
    if (!run.isInTime()) GTEST_SKIP() << kTooBusy;
    expectStable(run);
    EXPECT_LT(run.rest.force.x(), -1) << "it must press, and be felt";
    EXPECT_NEAR(run.rest.p_tool.x(), 0, kVoxel) << "it stays in its corridor";
    EXPECT_LT(run.rest.penetration, kVoxel);
}

// Beyond 18 N/mm the simulated loop is unstable with a hand. The device says what it is like, and the
// coupling gives way.
TEST_F(LiveLoop, ACouplingThatIsTooStiffGivesWay) {
    const LiveRun run = quietSession(wallPress("coupling { translation_stiffness_n_per_mm: 20 }"));
    if (!run.isInTime()) GTEST_SKIP() << kTooBusy;
    expectStable(run);
}

// Without this the others might see nothing: the thesis' coupling without its damping knows nothing of the
// device, and the encoders' steps keep it swinging.
TEST_F(LiveLoop, ACouplingWithoutDampingIsSeenToSwing) {
    constexpr double kSeen = 0.01;  // N RMS: a thousand times what the fitted coupling leaves
    const LiveRun run = sessionWith(
        &LiveRun::hasRest, wallPress("accuracy { preset: THESIS_2012 } "
                                     "coupling { translation_stiffness_n_per_mm: 20 static_damping: 0 }"));
    if (!run.isInTime()) GTEST_SKIP() << kTooBusy;
    const bool swings = run.hasRest() && run.rest.force_rms > kSeen;
    EXPECT_TRUE(swings || isStoppedByItself(run));
}

}  // namespace
}  // namespace bonemill
