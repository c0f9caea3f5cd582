// Whoever reads what our programs print may go at any time. That ends no program; but one that was to print
// something, and could not, has failed and says so.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::TemporaryFolder;
using Words = std::vector<std::string>;

// What bash does with standard output before it becomes the program.
constexpr char kFull[] = "exec >/dev/full";
constexpr char kClosed[] = "exec >&-";
// A pipe that nobody reads any more.
constexpr char kUnread[] =
    R"(pipe=$(mktemp -u) && mkfifo "$pipe" && exec 3<>"$pipe" >"$pipe" 3<&- && rm "$pipe")";

// Standard error goes along where `and_errors`.
Words into(const std::string& place, Words words, bool and_errors = false) {
    words[0] = test::binDir() + "/" + words[0];
    words.insert(words.begin(), {"/bin/bash", "-c",
                                 place + (and_errors ? " && exec 2>&1" : "") + " && exec \"$@\"", "bash"});
    return words;
}

std::string slabScene(const TemporaryFolder& folder) {
    const auto made = test::run({"make_phantom", "body", "--kind", "slab", "--out", folder / "slab.nrrd"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    test::writeFile(folder / "s.textproto",
                    "volume { path: \"slab.nrrd\" }\n"
                    "simulated_operator { waypoint { time_s: 0 p_WT_mm { z: 9 } }\n"
                    "  waypoint { time_s: 1 p_WT_mm { z: 8 } } }\n");
    return folder / "s.textproto";
}

TEST(LostReader, ACommandThatCannotPrintFailsAndSaysSo) {
    const TemporaryFolder folder;
    const std::string scene = slabScene(folder);
    test::writeFile(folder / "path.csv", "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n0,0,0,0.009,1,0,0,0,0\n");
    const std::vector<Words> commands{
        {"haptic_server", "--describe-scene", "--scene", scene},
        {"haptic_server", "simulate", "--scene", scene, "--trajectory", folder / "path.csv"},
        {"haptic_server", "--list-scenes", "--scene", scene},
        {"device_daemon", "--describe", "--scene", scene},
        {"study", "plan", "--groups", "12", "12"},
        {"bonemill_lab", "session", "--help"},
        {"make_phantom", "--version"},
        {"ares_emulator", "--version"},
        {"render_client", "--version"},
        {"bonemill_bridge_touch", "--version"},
        {"haptic_bench", "--help"}};
    for (const Words& command : commands) {
        const Finished printed = test::run(command);
        EXPECT_EQ(printed.exit_code, 0) << command[0] << ' ' << command[1] << printed.err;
        EXPECT_NE(printed.out, "") << command[0] << ' ' << command[1] << " is to print something";
        for (const char* const place : {kFull, kClosed, kUnread}) {
            const Finished lost = test::run(into(place, command));
            EXPECT_EQ(lost.exit_code, 2) << place << ": " << command[0] << ' ' << command[1];
            EXPECT_NE(lost.err.find("error: standard output cannot be written"), std::string::npos)
                << place << ": " << command[0] << ' ' << command[1] << ": " << lost.err;
        }
    }
}

TEST(LostReader, ASessionGoesOnToItsEndAndKeepsWhatItHasMade) {
    const TemporaryFolder folder;
    const std::string scene = slabScene(folder), session = std::to_string(testSession());
    Process server(into(kUnread,
                        {"haptic_server", "--scene", scene, "--session", session, "--domain",
                         std::to_string(testDomain()), "--no-recording", "--until-device-leaves", "--report",
                         folder / "report.json", "--save-volume", folder / "milled.nrrd"},
                        true));
    Process daemon(into(
        kUnread, {"device_daemon", "--device", "simulated", "--scene", scene, "--session", session}, true));
    EXPECT_EQ(daemon.wait().exit_code, 0);
    EXPECT_EQ(server.wait().exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "report.json"));
    EXPECT_TRUE(std::filesystem::exists(folder / "milled.nrrd"));
}

}  // namespace
}  // namespace bonemill
