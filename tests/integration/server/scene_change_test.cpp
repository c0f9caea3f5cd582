// A class without typing: the scene of a live session changes for all viewers and the device at once, and
// attempts are kept book of. haptic_server, device_daemon and its emulator are processes; the test itself is
// two viewers.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "common/attempts_csv/attempts_csv.h"
#include "common/device_messages/device_state.h"
#include "haptic_server/server/session/attempt_controller.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;

constexpr double kLongestWait_s =
    0.005;  // five periods: ticks that are farther apart do not follow one another
constexpr double kFastestRamp_s = 0.03;  // StaleRampConfig::ramp_down_ns

// What the trace says of the wrench on the hand.
struct TracedForce {
    double first = -1, last = -1, most = 0;  // N
    double largest_step = 0;                 // N, between ticks that follow one another
    double steepest = 0;                     // N/s, over ticks that a busy machine let wait
};

TracedForce forceIn(const std::string& trace) {
    std::ifstream file(trace);
    std::string line;
    std::getline(file, line);
    TracedForce force;
    for (double before[3]{}, t_before_s = 0; std::getline(file, line);) {
        std::istringstream fields(line);
        std::string field;
        double now[3]{}, t_s = 0, sum = 0, step = 0;
        for (int column = 0; column < 18 && std::getline(fields, field, ','); ++column) {
            if (column == 0) t_s = std::stod(field);
            if (column >= 15) now[column - 15] = std::stod(field);
        }
        for (int axis = 0; axis < 3; ++axis) {
            sum += now[axis] * now[axis];
            step += (now[axis] - before[axis]) * (now[axis] - before[axis]);
            before[axis] = now[axis];
        }
        force.last = std::sqrt(sum);
        if (force.first < 0) force.first = force.last;
        force.most = std::max(force.most, force.last);
        const double gap_s = t_s - std::exchange(t_before_s, t_s);
        if (gap_s < kLongestWait_s)
            force.largest_step = std::max(force.largest_step, std::sqrt(step));
        else
            force.steepest = std::max(force.steepest, std::sqrt(step) / gap_s);
    }
    return force;
}

// The simulated hand presses on a slab with its top at z = 2 mm, in scene `b` with the pedal down and turned
// base.
class SceneChange : public testing::Test {
  protected:
    SceneChange() {
        EXPECT_EQ(
            test::run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
            0);
        test::writeFile(folder_ / "torn.nrrd", "no scan");
        writeScene("a", "slab.nrrd", 2);
        writeScene("b", "slab.nrrd", 3);
        writeScene("torn", "torn.nrrd", 2);
        test::writeFile(folder_ / "broken.textproto", "volum { }");
    }
    void writeScene(const std::string& name, const std::string& volume, int base_z_mm) const {
        const auto waypoint = [&](double time_s, double z_mm) {
            return "  waypoint { time_s: " + std::to_string(time_s) +
                   " p_WT_mm { x: 0 y: 0.1 z: " + std::to_string(z_mm) +
                   " } q_WT { w: 0.70710678 x: 0.70710678 } }\n";
        };
        test::writeFile(folder_ / (name + ".textproto"),
                        "name: \"" + name + "\" title: \"Task " + name +
                            "\" effects { time_removal {} } volume { path: \"" + volume +
                            "\" window_low: 0 window_high: 65535 iso_value: 32768 }\n" +
                            "device { p_WD_mm { x: 0 y: 0.1 z: " + std::to_string(base_z_mm) +
                            " } q_WD { w: 0.70710678 x: 0.70710678 } }\nsimulated_operator {\n" +
                            waypoint(0, 3.4) + waypoint(0.5, 2.3) + waypoint(300, 2.2) + "}\n");
    }
    std::vector<std::string> server() const {
        return {"haptic_server",
                "--scene",
                folder_ / "a.textproto",
                "--session",
                std::to_string(testSession()),
                "--domain",
                std::to_string(testDomain()),
                "--trace",
                folder_ / "trace.csv",
                "--class-table",
                folder_ / "class.csv"};
    }
    static std::vector<std::string> daemon() {
        return {"device_daemon", "--device",  "simulated",
                "--hold",        "--session", std::to_string(testSession())};
    }

    template <class Condition>
    bool waitForBoth(Condition&& condition) {
        return one_.pollUntil([&] {
            two_.poll();
            return condition(one_.subscriber) && condition(two_.subscriber);
        });
    }
    // Both viewers have all of the scene, in the state that the server counts, and the hand feels it.
    bool isFelt(const std::string& scene) {
        return waitForBoth([&](const SceneSubscriber& viewer) {
            return viewer.status() && viewer.status()->scene() == scene && viewer.isComplete() &&
                   viewer.sceneInfo() && viewer.sceneInfo()->name() == scene && viewer.lesson() &&
                   viewer.lesson()->scene_id() == scene &&
                   viewer.status()->device().state() == uint32_t(SafetyState::kEngaged) &&
                   viewer.toolState() &&
                   std::hypot(viewer.toolState()->force_n(0), viewer.toolState()->force_n(1),
                              viewer.toolState()->force_n(2)) > 0.1;
        });
    }
    // For a test that fails.
    std::string stateOf(const SceneSubscriber& viewer) const {
        std::string text = viewer.isComplete() ? "complete" : "not complete";
        if (viewer.status())
            text += ", scene " + viewer.status()->scene() + ", device " +
                    std::to_string(viewer.status()->device().state());
        if (viewer.lesson()) text += ", lesson " + viewer.lesson()->scene_id();
        if (viewer.toolState())
            text += ", force " + std::to_string(viewer.toolState()->force_n(2)) + " N at " +
                    std::to_string(1e3 * viewer.toolState()->p_wt_m(2)) + " mm";
        return text;
    }
    std::string answerTo(void (*fill)(topics::Command&)) {
        topics::Command command;
        fill(command);
        one_.subscriber.sendCommand(command);
        std::string answer = "none";
        one_.pollUntil([&] {
            two_.poll();
            for (const CommandOutcome& outcome : one_.subscriber.takeOutcomes()) answer = outcome.answer.text;
            return answer != "none";
        });
        return answer;
    }

    // What the window, the class table, the result and the report tell of an attempt is the same.
    void expectSameFigures(const topics::Attempt& attempt, const std::string& table) const {
        std::vector<std::filesystem::path> results;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "results"))
            if (entry.path().extension() == ".json") results.push_back(entry.path());
        ASSERT_EQ(results.size(), 1u);
        const auto result = nlohmann::json::parse(test::readFile(results[0]));
        double force = 0, removed = 0;
        for (const auto& figure : result["figures"]) {
            if (figure["id"] == "force.max") force = figure["value"];
            if (figure["id"] == "removal.volume") removed = figure["value"];
        }
        EXPECT_NEAR(force, attempt.max_force_n(), 1e-4 * force);
        EXPECT_NEAR(removed, attempt.removed_mm3(), 1e-9);
        EXPECT_DOUBLE_EQ(result["duration_s"], attempt.time_s());
        std::ostringstream cells;
        cells.precision(6);
        cells << ',' << attempt.time_s() << ',' << attempt.removed_mm3() << ',' << attempt.max_force_n()
              << ',';
        EXPECT_NE(table.find(cells.str()), std::string::npos) << cells.str() << " in " << table;
        const std::string report = test::readFile(results[0].replace_extension(".html"));
        EXPECT_NE(report.find("Task a"), std::string::npos);
        EXPECT_NE(test::readFile(folder_ / "class.html").find("Task a"), std::string::npos);
    }

    test::TemporaryFolder folder_;
    ClientProbe one_, two_;
};

TEST_F(SceneChange, ReachesViewersAndTheHandAtOnceWithoutAStepOfForce) {
    Process server_process(server()), daemon_process(daemon());
    ASSERT_TRUE(isFelt("a")) << stateOf(one_.subscriber) << "; " << stateOf(two_.subscriber);
    ASSERT_EQ(one_.subscriber.lesson()->scenes_size(), 4);
    EXPECT_EQ(one_.subscriber.lesson()->scenes(0).title(), "Task a");
    EXPECT_NE(one_.subscriber.lesson()->scenes(2).problem(), "") << "it is broken";
    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_start_attempt("=Ann"); }), "done");
    ASSERT_TRUE(waitForBoth([](const SceneSubscriber& viewer) { return viewer.lesson()->is_running(); }));
    const double start_s = one_.subscriber.status()->session_s();
    ASSERT_TRUE(waitForBoth([&](const SceneSubscriber& viewer) {
        return viewer.status()->session_s() > start_s + AttemptController::kShortest;
    }));

    const uint64_t epoch_of_a = one_.subscriber.epoch();
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_choose_scene("b"); }), "done");
    ASSERT_TRUE(isFelt("b")) << stateOf(one_.subscriber) << "; " << stateOf(two_.subscriber);
    RecordProperty(
        "change_s",
        std::to_string(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
    EXPECT_GT(one_.subscriber.epoch(), epoch_of_a);
    EXPECT_EQ(one_.subscriber.epoch(), two_.subscriber.epoch());
    EXPECT_EQ(one_.clearings, 1u);
    ASSERT_EQ(two_.subscriber.lesson()->attempts_size(), 1);
    const topics::Attempt attempt = two_.subscriber.lesson()->attempts(0);
    EXPECT_EQ(attempt.trainee(), "=Ann");
    EXPECT_EQ(attempt.scene_id(), "a");
    EXPECT_GT(attempt.max_force_n(), 0.1);

    for (const auto choose : {+[](topics::Command& c) { c.set_choose_scene("torn"); },
                              +[](topics::Command& c) { c.set_choose_scene("broken"); }}) {
        const std::string answer = answerTo(choose);
        EXPECT_EQ(answer.rfind("refused: ", 0), 0u) << answer;
        EXPECT_NE(answer.find(folder_.path()), std::string::npos) << "it says which file: " << answer;
    }
    EXPECT_TRUE(isFelt("b")) << "the scene stays";

    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_choose_scene("a"); }), "done");
    ASSERT_TRUE(isFelt("a"));
    ClientProbe late;
    EXPECT_TRUE(late.pollUntilComplete(one_.digestLine())) << "who joins later sees this scene only";
    EXPECT_EQ(late.nodes.size(), one_.nodes.size());
    EXPECT_TRUE(server_process.isRunning() && daemon_process.isRunning());

    daemon_process.signal(SIGTERM);
    const test::Finished daemon_end = daemon_process.wait();
    EXPECT_EQ(daemon_end.exit_code, 0) << daemon_end.err;
    server_process.signal(SIGTERM);
    const test::Finished server_end = server_process.wait();
    EXPECT_EQ(server_end.exit_code, 0) << server_end.err;
    for (const char* name : {"trace.csv", "trace_2.csv", "trace_3.csv"}) {
        const TracedForce force = forceIn(folder_ / name);
        EXPECT_GT(force.most, 0.1) << name;
        EXPECT_LT(force.largest_step, 0.3) << name;
        EXPECT_LT(force.steepest, 2 * force.most / kFastestRamp_s) << name;
        EXPECT_LT(force.first, 0.01) << name << ": it fades in";
        if (std::string(name) != "trace_3.csv") {
            EXPECT_LT(force.last, 0.01) << name << ": it fades out";
        }
    }
    for (const char* name : {"trace.csv", "trace_2.csv", "class.csv"}) {
        EXPECT_EQ(std::filesystem::status(folder_ / name).permissions(),
                  std::filesystem::perms::owner_read | std::filesystem::perms::owner_write)
            << name;
    }
    const std::string table = test::readFile(folder_ / "class.csv");
    EXPECT_EQ(table.find(attemptsHeaderLine() + "1,"), 0u) << table;
    EXPECT_NE(table.find(",\"'=Ann\",\"Task a\","), std::string::npos) << table;
    expectSameFigures(attempt, table);
}

// What the hand did before belongs to no attempt.
TEST_F(SceneChange, TheSimulatedHandBeginsAnewWithAnAttemptAndRestsAfterIt) {
    Process server_process(server()), daemon_process(daemon());
    ASSERT_TRUE(isFelt("a")) << stateOf(one_.subscriber) << "; " << stateOf(two_.subscriber);
    // It rubs in its guides: it does not come all the way back.
    const auto isAtItsStart = [](const SceneSubscriber& viewer) {
        return viewer.toolState() && viewer.toolState()->p_wt_m(2) > 3.04e-3;
    };
    const auto start = +[](topics::Command& c) { c.set_start_attempt("Ann"); };
    EXPECT_EQ(answerTo(start), "done");
    EXPECT_TRUE(waitForBoth(isAtItsStart)) << stateOf(one_.subscriber);
    EXPECT_TRUE(isFelt("a")) << stateOf(one_.subscriber);
    EXPECT_EQ(answerTo(start), "done");
    EXPECT_TRUE(waitForBoth(isAtItsStart)) << "once more: " << stateOf(one_.subscriber);
    EXPECT_TRUE(isFelt("a"));
    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_stop_attempt(true); }), "done");
    EXPECT_TRUE(waitForBoth(isAtItsStart)) << "it rests: " << stateOf(one_.subscriber);
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
    const TracedForce force = forceIn(folder_ / "trace.csv");
    EXPECT_GT(force.most, 0.1);
    EXPECT_LT(force.largest_step, 0.3);
}

TEST_F(SceneChange, WhatASceneLacksIsMadeWhenItIsChosen) {
    for (const char* name : {"late", "lost", "never"}) writeScene(name, std::string(name) + ".nrrd", 2);
    test::writeFile(folder_ / "launcher",
                    "#!/bin/bash\ncd \"${0%/*}\"\n[[ $1 == prepare ]] || exit 3\n"
                    "if [[ $2 == */late.textproto ]]; then cp slab.nrrd late.nrrd; exit; fi\n"
                    "echo 'bonemill: it is no phantom' >&2\nexit 2\n");
    std::filesystem::permissions(folder_ / "launcher", std::filesystem::perms::owner_all);
    std::vector<std::string> words = server();
    words.insert(words.end(), {"--launcher", folder_ / "launcher", "--makes=late", "--makes=never"});
    Process server_process(words);
    const auto lessonOf = [&](const char* id) {
        for (const topics::SceneChoice& scene : one_.subscriber.lesson()->scenes())
            if (scene.id() == id) return scene;
        return topics::SceneChoice();
    };
    ASSERT_TRUE(one_.pollUntil([&] { return one_.subscriber.lesson() && one_.subscriber.status(); }));
    EXPECT_TRUE(lessonOf("late").is_made_first());
    EXPECT_EQ(lessonOf("late").problem(), "");
    EXPECT_NE(lessonOf("lost").problem(), "") << "nobody makes it";
    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_choose_scene("never"); }),
              "refused: what never reads could not be made: bonemill: it is no phantom");
    EXPECT_EQ(answerTo([](topics::Command& c) { c.set_choose_scene("late"); }), "done");
    EXPECT_TRUE(one_.pollUntil([&] {
        return one_.subscriber.lesson() && one_.subscriber.lesson()->scene_id() == "late" &&
               !lessonOf("late").is_made_first() && lessonOf("never").is_made_first();
    }));
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
}

TEST_F(SceneChange, ScenesAreListedAndTheFirstGoodOneIsTaken) {
    test::writeFile(folder_ / "0.textproto", "volum { }");
    const test::Finished list = test::run({"haptic_server", "--scenes", folder_.path(), "--list-scenes"});
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_NE(list.out.find("Task b"), std::string::npos) << list.out;
    EXPECT_NE(list.out.find("cannot be chosen: "), std::string::npos) << list.out;
    Process server_process({"haptic_server", "--scenes", folder_.path(), "--session",
                            std::to_string(testSession()), "--domain", std::to_string(testDomain())});
    ASSERT_TRUE(one_.pollUntil([&] { return one_.subscriber.lesson() && one_.subscriber.status(); }));
    EXPECT_EQ(one_.subscriber.lesson()->scene_id(), "a");
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
    EXPECT_EQ(test::run({"haptic_server", "--scenes", folder_ / "none"}).exit_code, 2);
}

}  // namespace
}  // namespace bonemill
