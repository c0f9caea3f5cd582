// What goes wrong at somebody's first start is said in one plain line, with what to type, by the real
// programs.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::run;
using test::writeFile;

constexpr const char* kHeader = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
const std::vector<std::string> kPrograms = {"haptic_server", "device_daemon", "ares_emulator",
                                            "render_client", "make_phantom"};

std::string utf16(const std::string& text, bool has_mark = true) {
    std::string wide = has_mark ? "\xff\xfe" : "";
    for (const char letter : text) wide += {letter, '\0'};
    return wide;
}

class FirstStart : public testing::Test {
  protected:
    FirstStart() {
        writeFile(folder_ / "t.csv", kHeader + std::string("0,0,0,0,1,0,0,0,0\n0.001,0,0,0,1,0,0,0,0\n"));
        const auto made = run({"make_phantom", "body", "--kind", "sphere", "--out", folder_ / "ball.nrrd"});
        EXPECT_EQ(made.exit_code, 0) << made.err;
        writeFile(folder_ / "ball.textproto", kBall);
    }

    std::vector<std::string> simulate(const std::string& scene, const std::string& trajectory) const {
        return {"haptic_server", "simulate",     "--scene",
                folder_ / scene, "--trajectory", folder_ / trajectory};
    }
    std::vector<std::string> simulateText(const std::string& scene) const {
        writeFile(folder_ / "s.textproto", scene);
        return simulate("s.textproto", "t.csv");
    }
    // Runs a program in a shell that has been told `limits` before, as "ulimit -n 16".
    static test::Finished within(const std::string& limits, const std::vector<std::string>& words) {
        std::string command = limits + "; exec " + test::binDir() + "/" + words[0];
        for (size_t n = 1; n < words.size(); ++n) command += " '" + words[n] + "'";
        return run({"/bin/sh", "-c", command});
    }
    static void expectError(const test::Finished& finished, int exit_code,
                            const std::vector<std::string>& words) {
        EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
        const size_t error = finished.err.rfind("error: ");
        ASSERT_NE(error, std::string::npos) << finished.err;
        EXPECT_EQ(std::count(finished.err.begin() + std::ptrdiff_t(error), finished.err.end(), '\n'), 1)
            << finished.err;
        for (const std::string& word : words)
            EXPECT_NE(finished.err.find(word, error), std::string::npos) << word << " in: " << finished.err;
    }

    static constexpr const char* kBall = "volume { path: \"ball.nrrd\" }\n";
    test::TemporaryFolder folder_;
};

TEST_F(FirstStart, EveryProgramSaysItsVersion) {
    for (const std::string& program : kPrograms) {
        const auto finished = run({program, "--version"});
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        EXPECT_EQ(finished.out.rfind(program + " 0.", 0), 0u) << finished.out;
        EXPECT_EQ(std::count(finished.out.begin(), finished.out.end(), '\n'), 1) << finished.out;
        EXPECT_NE(finished.out.find(__VERSION__), std::string::npos) << "how it was built: " << finished.out;
    }
}

TEST_F(FirstStart, TimesThatAreNoneAreRefused) {
    const std::string scene = folder_ / "ball.textproto";
    for (const std::string program : {"haptic_server", "device_daemon", "ares_emulator"})
        for (const std::string seconds : {"-5", "nan", "inf", "1e300"})
            expectError(run({program, "--scene", scene, "--seconds", seconds}), 2, {"--seconds", seconds});
    expectError(run({"device_daemon", "--scene", scene, "--wait-seconds", "nan"}), 2, {"--wait-seconds"});
    expectError(run({"ares_emulator", "--scene", scene, "--rate", "nan"}), 2, {"--rate"});
    expectError(run({"haptic_server", "--scene", scene, "--stream-mbit-per-s", "nan"}), 2,
                {"--stream-mbit-per-s"});
    expectError(run({"render_client", "--camera-azimuth-deg", "nan"}), 2, {"--camera-azimuth-deg"});
}

TEST_F(FirstStart, FewFileHandlesAreSaid) {
    const std::string scene = folder_ / "ball.textproto";
    const std::vector<std::string> words{"16", "ulimit -n 1024"};
    expectError(within("ulimit -n 16", {"haptic_server", "--scene", scene, "--session", "951"}), 2, words);
    expectError(within("ulimit -n 16", {"device_daemon", "--scene", scene, "--session", "951"}), 2, words);
    expectError(within("ulimit -n 16", {"render_client", "--offscreen", "--out", folder_ / "o"}), 2, words);
    EXPECT_EQ(within("ulimit -S -n 16", simulate("ball.textproto", "t.csv")).exit_code, 0)
        << "the user may raise it, so the program does";
}

TEST_F(FirstStart, TooLittleMemoryIsSaid) {
    const std::string scene = folder_ / "ball.textproto";
    expectError(within("ulimit -v 230000", {"haptic_server", "--scene", scene, "--session", "951"}), 2,
                {"not enough memory for the network", "ulimit -v"});
    expectError(within("ulimit -v 600000", {"render_client", "--offscreen", "--out", folder_ / "o"}), 2,
                {"not enough memory for the pictures", "ulimit -v"});
    expectError(within("ulimit -v 100000", {"make_phantom", "tooth", "--out", folder_ / "tooth"}), 1,
                {"not enough memory", "ulimit -v"});
}

TEST_F(FirstStart, Utf16IsNamedAndTheMarkOfUtf8IsPassedOver) {
    const std::vector<std::string> words{"is UTF-16; save it as UTF-8"};
    const std::string csv = test::readFile(folder_ / "t.csv"), mark = "\xef\xbb\xbf";
    expectError(run(simulateText(utf16(kBall))), 2, words);
    expectError(run(simulateText(utf16(kBall, false))), 2, words);
    writeFile(folder_ / "wide.csv", utf16(csv));
    expectError(run(simulate("ball.textproto", "wide.csv")), 2, words);
    const std::string figures = R"({"settings": {}})";
    writeFile(folder_ / "wide.json", utf16(figures));
    const std::string scene = folder_ / "ball.textproto";
    expectError(
        run({"haptic_server", "--scene", scene, "--session", "951", "--accuracy", folder_ / "wide.json"}), 2,
        words);
    writeFile(folder_ / "marked.csv", mark + csv);
    writeFile(folder_ / "s.textproto", mark + kBall);
    const auto finished = run(simulate("s.textproto", "marked.csv"));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
}

TEST_F(FirstStart, AWrongChoiceListsTheRightOnes) {
    expectError(run(simulateText(kBall + std::string("tool { burr_kind: SPHERE }"))), 2,
                {"s.textproto:2", "burr_kind", "SPHERE", "BALL", "CYLINDER"});
    expectError(run(simulateText(kBall + std::string("accuracy { preset: FASTT }"))), 2,
                {"s.textproto:2", "preset", "FASTT", "BALANCED", "EXACT"});
}

TEST_F(FirstStart, AMissingPhantomSaysWhatMakesIt) {
    expectError(run(simulateText("volume { path: \"build/data/tooth\" }")), 2,
                {"build/data/tooth", "deploy/make-phantoms"});
}

TEST_F(FirstStart, AnIsoValueAtTheEdgeOfTheWindow) {
    const std::string window = "volume { path: \"ball.nrrd\" window_low: 0 window_high: 65535 iso_value: ";
    for (const std::string iso : {"0.1", "65534.9", "65535"})
        expectError(run(simulateText(window + iso + " }")), 2, {iso, "window"});
}

TEST_F(FirstStart, ATrajectoryInMillimetres) {
    writeFile(folder_ / "mm.csv",
              kHeader + std::string("0,20,30,-40,1,0,0,0,0\n0.001,20,30,-40,1,0,0,0,0\n"));
    expectError(run(simulate("ball.textproto", "mm.csv")), 2, {"mm.csv", "53.", "metres", "millimetres"});
    std::string across = kHeader;  // of a small bone around W's origin
    for (int n = 0; n < 21; ++n)
        across += "0.0" + std::string(n < 10 ? "0" : "") + std::to_string(n) + ",0,0," +
                  std::to_string(n - 10) + ",1,0,0,0,0\n";
    writeFile(folder_ / "mm.csv", across);
    expectError(run(simulate("ball.textproto", "mm.csv")), 2, {"mm.csv", "metres", "millimetres"});
}

// Root may write everywhere, so it is somebody else who tries.
TEST_F(FirstStart, APlaceThatCannotBeWrittenTo) {
    const std::string drop = geteuid() == 0 ? "exec setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
    const auto in_root = [&](const std::string& words) {
        return run({"/bin/sh", "-c", "cd /usr; " + drop + test::binDir() + "/" + words});
    };
    expectError(in_root("make_phantom body --kind sphere --out ball.nrrd"), 2,
                {"ball.nrrd", "cannot be written", "is yours"});
    expectError(in_root("render_client --session 951 --domain 95 --offscreen --frames 1 --out pictures"), 2,
                {"pictures"});
    EXPECT_FALSE(std::filesystem::exists("/usr/ball.nrrd"));
}

// A disk of its own needs the right to mount one, as root and owners of a user namespace have it.
TEST_F(FirstStart, AFullDiskLeavesNoHalfFile) {
    std::filesystem::create_directory(folder_ / "full");
    const std::string mount = std::string("unshare -m") + (geteuid() == 0 ? "" : " -r") + " /bin/sh -c '";
    const std::string disk =
        "mount -t tmpfs -o size=40k full " + (folder_ / "full") + " && cd " + (folder_ / "full");
    if (run({"/bin/sh", "-c", mount + disk + "'"}).exit_code != 0)
        GTEST_SKIP() << "nothing can be mounted here";
    const auto on_disk = [&](const std::string& words) {
        return run(
            {"/bin/sh", "-c",
             mount + disk + " && " + test::binDir() + "/" + words + "; code=$?; echo; ls -A; exit $code'"});
    };
    const auto body = on_disk("make_phantom body --kind sphere --out ball.nrrd --dims 200 200 200");
    expectError(body, 2, {"ball.nrrd", "full"});
    EXPECT_EQ(body.out, "\n");
    expectError(on_disk("make_phantom tooth --out tooth"), 2, {"slice_", "full"});
    // The mesh finds no room; the volume and the trace, which do, are saved all the same.
    const auto saved =
        on_disk("haptic_server simulate --scene " + (folder_ / "ball.textproto") + " --trajectory " +
                (folder_ / "t.csv") + " --save-mesh m.stl --save-volume v.nrrd --trace trace.csv");
    expectError(saved, 1, {"m.stl"});
    EXPECT_EQ(saved.out.substr(saved.out.rfind("\n\n")), "\n\ntrace.csv\nv.nrrd\n");
}

}  // namespace
}  // namespace bonemill
