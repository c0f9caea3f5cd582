#include "tests/integration/ros2/ros_session.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "common/ros/ros_domain.h"

namespace bonemill::test {

uint32_t rosTestDomain() {
    static const uint32_t domain = [] {
        testDomain();  // takes its own first
        uint32_t candidate = kFirstTestDomain;
        while (!claimDomain(candidate)) ++candidate;
        return candidate;
    }();
    return domain;
}

RosSession::RosSession() {
    setenv("ROS_LOCALHOST_ONLY", "1", 1);
    setenv("ROS_DOMAIN_ID", std::to_string(rosTestDomain()).c_str(), 1);
    EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code, 0);
    const std::string upright = "q_WT { w: 0.70710678 x: 0.70710678 }";
    writeFile(
        folder_ / "s.textproto",
        "name: \"ros\" volume { path: \"slab.nrrd\" } effects { time_removal { rate_density_per_s: 10 } }\n"
        "device { p_WD_mm { x: 0 y: 0.1 z: 2 } q_WD { w: 0.70710678 x: 0.70710678 } }\n"
        "simulated_operator { tremor_mm: 0.1\n"
        "  waypoint { time_s: 0 p_WT_mm { x: 0 y: 0.1 z: 3.6 } " +
            upright +
            " }\n"
            "  waypoint { time_s: 0.3 p_WT_mm { x: 0 y: 0.1 z: 0 } " +
            upright +
            " remove: true }\n"
            "  waypoint { time_s: 36000 p_WT_mm { x: 0 y: 0.1 z: -0.1 } " +
            upright + " } }\n");
}

std::vector<std::string> RosSession::serverWords() const {
    return {"haptic_server",
            "--scene",
            folder_ / "s.textproto",
            "--session",
            std::to_string(testSession()),
            "--domain",
            std::to_string(testDomain()),
            "--no-recording"};
}

std::vector<std::string> RosSession::daemonWords(const std::string& device) const {
    return {"device_daemon",
            "--device",
            device,
            "--scene",
            folder_ / "s.textproto",
            "--session",
            std::to_string(testSession()),
            "--stop-dir",
            folder_ / "stops"};
}

std::vector<std::string> RosSession::rosWords() {
    return {"bonemill_ros2", "--session", std::to_string(testSession()), "--domain",
            std::to_string(testDomain())};
}

std::unique_ptr<Process> RosSession::startServer() const {
    return std::make_unique<Process>(serverWords());
}

std::unique_ptr<Process> RosSession::startDaemon(const std::string& device,
                                                 const std::vector<std::string>& more) const {
    std::vector<std::string> words = daemonWords(device);
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Process>(words);
}

std::unique_ptr<Process> RosSession::startRos() const {
    return std::make_unique<Process>(rosWords());
}

dds::Participant RosSession::joinAsNode() const {
    return ros2::joinRos(ros2::rosOptionsOfEnvironment());
}

}  // namespace bonemill::test
