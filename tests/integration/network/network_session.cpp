#include "tests/integration/network/network_session.h"

#include <signal.h>
#include <unistd.h>

#include <sstream>

#include "tests/support/places.h"

namespace bonemill::test {

Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

void NetworkSession::SetUp() {
    if (const std::string missing = VirtualNetwork::enter(); !missing.empty()) GTEST_SKIP() << missing;
    network_ = std::make_unique<VirtualNetwork>();
    haptics_pc_ = std::make_unique<Host>(network_->addHost());
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code, 0);
}

// The hand goes down into the slab, whose top is at z = 2 mm, to and fro along x until the time is over,
// and up again. Server and daemon read the same scene, and the daemon ends its way early.
void NetworkSession::writeScene() const {
    constexpr int seconds = 8;
    constexpr double kLength_mm = 3;
    std::ostringstream text;
    const auto waypoint = [&](double time_s, double x_mm, double z_mm, const std::string& more) {
        text << "  waypoint { time_s: " << time_s << " p_WT_mm { x: " << x_mm << " y: 0.1 z: " << z_mm
             << " } q_WT { w: 0.70710678 x: 0.70710678 } " << more << " }\n";
    };
    text << "name: \"network\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
            "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
            "simulated_operator {\n";
    waypoint(0, 0, 3.6, "phase: \"approach\"");
    waypoint(0.5, 0, 3.1, "remove: true phase: \"mill\"");
    for (int second = 1; second < seconds; ++second)
        waypoint(second, second % 2 ? -kLength_mm : kLength_mm, 2.6 - 1.5 * second / seconds, "remove: true");
    waypoint(seconds, 0, 1.0, "phase: \"withdraw\"");
    waypoint(seconds + 0.5, 0, 3.6, "");
    writeFile(folder_ / "scene.textproto", text.str() + "}\n");
}

void NetworkSession::startServer(const Words& network) {
    writeScene();
    server_ = haptics_pc_->start(joined(Words{"haptic_server", "--scene", folder_ / "scene.textproto",
                                              "--session", session_, "--report", folder_ / "report.json"},
                                        network));
}

void NetworkSession::startMilling(int seconds) {
    daemon_ =
        haptics_pc_->start({"device_daemon", "--device", "simulated", "--scene", folder_ / "scene.textproto",
                            "--session", session_, "--seconds", std::to_string(seconds)});
}

void NetworkSession::waitForDevice() {
    const Finished finished = daemon_->wait();
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
}

std::unique_ptr<Process> NetworkSession::probe(const Host& host, const Words& network) {
    return host.start(joined(Words{test::helperDir() + "/probe_viewer", "--session", session_}, network));
}

nlohmann::json NetworkSession::newest(const Process& probe) {
    const std::string lines = probe.outSoFar();
    const size_t end = lines.rfind('\n');
    if (end == std::string::npos)
        return {{"complete", false}, {"server", false}, {"digest", ""}, {"changes", 0}};
    const size_t before = end == 0 ? std::string::npos : lines.rfind('\n', end - 1);
    const size_t begin = before == std::string::npos ? 0 : before + 1;
    return nlohmann::json::parse(lines.substr(begin, end - begin));
}

nlohmann::json NetworkSession::picture(const Host& host, const Words& network) {
    const Finished finished =
        host.start(joined(Words{"render_client", "--offscreen", "--out", folder_ / "pictures", "--size",
                                "96x64", "--wait-complete", "--timeout-s", "30", "--session", session_},
                          network))
            ->wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.exit_code == 0 ? nlohmann::json::parse(finished.out) : nlohmann::json{};
}

nlohmann::json NetworkSession::stopServer() {
    server_->signal(SIGTERM);
    const Finished finished = server_->wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return nlohmann::json::parse(readFile(folder_ / "report.json"));
}

bool NetworkSession::isWhole(const Process& probe) {
    return newest(probe)["complete"] == true;
}

bool NetworkSession::agree(const std::vector<const Process*>& probes) {
    const nlohmann::json first = newest(*probes.front());
    for (const Process* probe : probes) {
        const nlohmann::json line = newest(*probe);
        if (line["complete"] != true || line["digest"] != first["digest"]) return false;
    }
    return true;
}

}  // namespace bonemill::test
