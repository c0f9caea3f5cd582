#include "tests/gl/window/mouse_session.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/dds_session.h"

namespace bonemill::test {

std::vector<std::string> viewerWords(const std::vector<std::string>& more) {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("LP_NUM_THREADS", "1", 1);
    std::vector<std::string> words{
        "render_client",
        "--size",
        std::to_string(kMouseScreenWidth) + "x" + std::to_string(kMouseScreenHeight),
        "--domain",
        std::to_string(testDomain()),
        "--session",
        std::to_string(testSession())};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

MouseSession::MouseSession() {
    const std::string domain = std::to_string(testDomain()), session = std::to_string(testSession());
    EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code, 0);
    const std::string scene = folder_ / "s.textproto";
    writeFile(scene,
              "name: \"mouse\" effects { time_removal {} } volume { path: \"slab.nrrd\" window_low: 0 "
              "window_high: 65535 iso_value: 32768 }\n"
              "device { p_WD_mm { x: 0 y: 0.1 z: 6 } q_WD { w: 0.70710678 x: 0.70710678 } }\n");
    const auto start = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = more;
        words.insert(words.end(), {"--scene", scene, "--session", session, "--domain", domain});
        return std::make_unique<Process>(words);
    };
    server_ = start({"haptic_server", "--report", folder_ / "report.json"});
    daemon_ = start({"device_daemon", "--device", "pointer", "--stop-dir", folder_ / "stops"});
    viewer_ = std::make_unique<Process>(viewerWords({"--hold-tool"}));
}

MouseSession::Ended MouseSession::end() {
    const auto finish = [](Process& program) {
        program.signal(SIGTERM);
        return program.wait();
    };
    Ended ended{
        .viewer = finish(*viewer_), .daemon = finish(*daemon_), .server = finish(*server_), .report = {}};
    ended.report = readFile(folder_ / "report.json");
    return ended;
}

}  // namespace bonemill::test
