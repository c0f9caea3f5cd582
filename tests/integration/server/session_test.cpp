// Runs whole sessions, with haptic_server, device_daemon and render_client as processes.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;
using test::run;
using test::TemporaryFolder;
using test::waitFor;
using test::writeFile;

// The simulated hand mills a slab (top at z = 2 mm) for three seconds.
class Session : public testing::Test {
  protected:
    Session() : session_(std::to_string(testSession())), domain_(std::to_string(testDomain())) {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        const std::string upright = "q_WT { w: 0.70710678 x: 0.70710678 }";
        writeFile(folder_ / "s.textproto",
                  "name: \"session\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
                  "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
                  "simulated_operator {\n"
                  "  waypoint { time_s: 0 p_WT_mm { x: 0 y: 0.1 z: 3.6 } " +
                      upright +
                      " phase: \"approach\" }\n"
                      "  waypoint { time_s: 1 p_WT_mm { x: 0 y: 0.1 z: 3.1 } " +
                      upright +
                      " remove: true phase: \"mill\" }\n"
                      "  waypoint { time_s: 3 p_WT_mm { x: 0 y: 0.1 z: 0.6 } " +
                      upright +
                      " phase: \"withdraw\" }\n"
                      "  waypoint { time_s: 4 p_WT_mm { x: 0 y: 0.1 z: 3.6 } " +
                      upright +
                      " }\n"
                      "}\n");
    }
    std::vector<std::string> server(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"haptic_server", "--scene",  folder_ / "s.textproto",
                                           "--session",     session_,   "--domain",
                                           domain_,         "--report", folder_ / "report.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    std::vector<std::string> daemon() {
        return {"device_daemon",         "--device",  "simulated", "--scene",
                folder_ / "s.textproto", "--session", session_};
    }
    std::vector<std::string> client(const std::string& out, int frames, int interval_ms) {
        return {"render_client",
                "--offscreen",
                "--frames",
                std::to_string(frames),
                "--interval-ms",
                std::to_string(interval_ms),
                "--out",
                folder_ / out,
                "--size",
                "320x200",
                "--wait-complete",
                "--session",
                session_,
                "--domain",
                domain_};
    }
    // The newest line of an offscreen viewer says what its newest picture shows; it is null before the first.
    static nlohmann::json newest(const Process& client) {
        const std::string out = client.outSoFar();
        const size_t end = out.rfind('\n');
        if (end == std::string::npos || end == 0) return {};
        const size_t before = out.rfind('\n', end - 1);
        const size_t begin = before == std::string::npos ? 0 : before + 1;
        return nlohmann::json::parse(out.substr(begin, end - begin));
    }
    static bool hasPicture(const Process& client) { return !newest(client).is_null(); }
    nlohmann::json report() { return nlohmann::json::parse(test::readFile(folder_ / "report.json")); }

    TemporaryFolder folder_;
    std::string session_, domain_;
};

TEST_F(Session, AKilledClientChangesNothingForTheServer) {
    Process server_process(server({"--until-device-leaves"}));
    Process client_process(client("pictures", 100000, 50));
    ASSERT_TRUE(waitFor([&] { return hasPicture(client_process); }));
    const auto untouched = newest(client_process)["node_digest"];
    Process daemon_process(daemon());
    ASSERT_TRUE(waitFor([&] { return newest(client_process)["node_digest"] != untouched; }));
    client_process.signal(SIGKILL);  // it has seen milling, which goes on
    EXPECT_EQ(daemon_process.wait().exit_code, 0);
    const auto finished = server_process.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const auto json = report();
    EXPECT_EQ(json["lost_records"].get<double>(), 0);
    EXPECT_TRUE(json["page_faults_after_warm_up"].contains("minor"));
    EXPECT_GT(json["removed_voxels"].get<double>(), 200);
    EXPECT_GT(json["cut_to_publisher_ms"]["p99"].get<double>(), 0);
    EXPECT_LE(json["cut_to_publisher_ms"]["p99"].get<double>(),
              json["cut_to_publisher_ms"]["max"].get<double>());
    EXPECT_GT(json["cuts"].get<double>(), 50);
    EXPECT_EQ(json["cuts_at_publisher"], json["cuts"]);  // it milled nothing in its last second
    // Only what a busy machine causes may be missing: the session itself ran to its end without a fault.
    EXPECT_FALSE(json["fault_ticks"].contains("solve"));
    EXPECT_FALSE(json["fault_ticks"].contains("bad_device_pose"));
}

// One viewer sees every change from the start, the other comes when all is done.
TEST_F(Session, ALateClientShowsTheSamePicture) {
    Process server_process(server());
    Process early(client("early", 100000, 250));
    ASSERT_TRUE(waitFor([&] { return hasPicture(early); }));
    Process daemon_process(daemon());
    EXPECT_EQ(daemon_process.wait().exit_code, 0);
    // The last meshes may still be on their way when the device has left.
    test::Finished late;
    ASSERT_TRUE(waitFor([&] {
        late = run(client("late", 1, 100));
        return late.exit_code != 0 ||
               nlohmann::json::parse(late.out)["node_digest"] == newest(early)["node_digest"];
    }));
    EXPECT_EQ(late.exit_code, 0) << late.err;
    early.signal(SIGTERM);
    const auto early_end = early.wait();
    EXPECT_EQ(early_end.exit_code, 0) << early_end.err;
    std::vector<std::string> lines;
    std::istringstream stream(early_end.out);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    ASSERT_GT(lines.size(), 1u);
    const auto first_json = nlohmann::json::parse(lines.front());
    const auto early_json = nlohmann::json::parse(lines.back()), late_json = nlohmann::json::parse(late.out);
    EXPECT_NE(first_json["node_digest"], early_json["node_digest"]);  // it saw the milling
    EXPECT_EQ(early_json["node_digest"], late_json["node_digest"]);
    EXPECT_TRUE(early_json["complete"] && late_json["complete"]);
    const auto picture = [this](const std::string& folder, const nlohmann::json& json) {
        return test::readFile(folder_ / (folder + "/" + json["file"].get<std::string>()));
    };
    EXPECT_GT(late_json["triangles"].get<double>(), 1000);
    EXPECT_EQ(early_json["triangles"], late_json["triangles"]);
    EXPECT_FALSE(picture("late", late_json).empty());
    server_process.signal(SIGTERM);
    EXPECT_EQ(server_process.wait().exit_code, 0);
}

TEST_F(Session, AnOutputThatCannotBeWrittenIsRefusedBeforeTheSession) {
    const auto expectRefused = [this](const std::string& option, const std::string& file) {
        const auto finished = run(server({option, folder_ / file}));
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_NE(finished.err.find(file), std::string::npos) << finished.err;
    };
    expectRefused("--trace", "no/such/folder/file");
    expectRefused("--save-volume", "no/such/folder/file.nrrd");
    expectRefused("--save-mesh", "no/such/folder/file.stl");
    expectRefused("--save-difference", "no/such/folder/file.nrrd");
    expectRefused("--export-dir", "no/such/folder");
    std::filesystem::create_directory(folder_ / "report.json");  // a folder where the report should go
    EXPECT_EQ(run(server()).exit_code, 2);
}

// The rows of a trace, also of one that is still being written: its last row may be cut off and is left out.
struct TraceRow {
    double force, contacts, removed;
    bool is_stale;
};
std::vector<TraceRow> rowsOf(const std::string& trace) {
    std::istringstream lines(trace.substr(0, trace.rfind('\n') + 1));
    std::string line;
    std::getline(lines, line);
    std::vector<TraceRow> rows;
    while (std::getline(lines, line)) {
        std::vector<double> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(std::stod(cell));
        rows.push_back({std::hypot(cells.at(15), cells.at(16), cells.at(17)), cells.at(21), cells.at(23),
                        bool(uint32_t(cells.at(25)) & kFaultStaleDevice)});
    }
    return rows;
}

TEST_F(Session, AKilledDaemonRampsTheForceDownAndANewOneGoesOn) {
    // The burr mills so slowly that the hand, which goes on, presses on it.
    const std::string scene = test::readFile(folder_ / "s.textproto"), at_once = "time_removal {}";
    writeFile(folder_ / "s.textproto", std::string(scene).replace(scene.find(at_once), at_once.size(),
                                                                  "time_removal { rate_density_per_s: 60 }"));
    const std::string trace = folder_ / "trace.csv";
    const auto hasRow = [&](auto&& isWanted) {
        return waitFor([&] {
            const auto rows = rowsOf(test::readFile(trace));
            return std::any_of(rows.begin(), rows.end(), isWanted);
        });
    };
    const auto is_zero_while_stale = [](const TraceRow& r) { return r.is_stale && r.force == 0; };
    Process server_process(server({"--trace", trace}));
    {
        Process daemon_process(daemon());
        ASSERT_TRUE(hasRow([](const TraceRow& r) { return r.force > 0.2; }));
        daemon_process.signal(SIGKILL);
    }
    ASSERT_TRUE(hasRow(is_zero_while_stale));
    Process second(daemon());
    EXPECT_EQ(second.wait().exit_code, 0);
    server_process.signal(SIGINT);
    EXPECT_EQ(server_process.wait().exit_code, 0);
    EXPECT_TRUE(report()["fault_ticks"].contains("stale_device"));

    bool saw_zero_while_stale = false, saw_fresh_after_stale = false;
    double force_before = 0, largest_step_down = 0, largest_force = 0, milled = 0;
    for (const TraceRow& r : rowsOf(test::readFile(trace))) {
        if (r.is_stale) {
            largest_step_down = std::max(largest_step_down, force_before - r.force);
            EXPECT_EQ(r.removed, 0) << "milled without a hand";
        }
        largest_force = std::max(largest_force, r.force);
        milled += r.removed;
        force_before = r.force;
        saw_zero_while_stale |= is_zero_while_stale(r);
        saw_fresh_after_stale |= saw_zero_while_stale && !r.is_stale && (r.contacts > 0 || r.removed > 0);
    }
    EXPECT_GT(milled, 0);
    EXPECT_LT(largest_step_down, 0.3 * largest_force) << "a ramp over 30 ms has no large steps";
    EXPECT_TRUE(saw_fresh_after_stale);
}

TEST_F(Session, WithoutPermissionTheServerSaysWhatIsMissing) {
    const std::string drop =
        geteuid() == 0 ? "setpriv --bounding-set=-sys_nice,-ipc_lock --inh-caps=-sys_nice,-ipc_lock " : "";
    const std::string server = "ulimit -r 0; ulimit -l 64; exec " + drop + test::binDir() +
                               "/haptic_server --scene " + (folder_ / "s.textproto") + " --session " +
                               session_ + " --domain " + domain_;
    test::Process going_on({"/bin/sh", "-c", server});
    EXPECT_TRUE(
        test::waitFor([&] { return going_on.errSoFar().find("waits for a device") != std::string::npos; }));
    going_on.signal(SIGTERM);
    const std::string said = going_on.wait().err, words = "real time: going on without";
    const size_t once = said.find(words);
    ASSERT_NE(once, std::string::npos) << said;
    EXPECT_EQ(said.find(words, once + 1), std::string::npos) << said;
    EXPECT_NE(said.find("deploy/check-realtime"), std::string::npos) << said;
    const auto finished = run({"/bin/sh", "-c", server + " --strict-rt"});
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    const size_t error = finished.err.find("error: ");
    ASSERT_NE(error, std::string::npos) << finished.err;
    for (const char* words : {"Memory is not locked", "No SCHED_FIFO", "--strict-rt"})
        EXPECT_NE(finished.err.find(words, error), std::string::npos) << words << " in: " << finished.err;
}

}  // namespace
}  // namespace bonemill
