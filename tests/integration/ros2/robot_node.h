// A robot's node, of Fast DDS: it writes servo_cp every millisecond, wherever the test wants it to be, and
// reads what it is given.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/ros2/fast_peer.h"

namespace bonemill::test {

struct ServoPose {
    std::array<double, 3> p{};              // m, in D
    std::array<double, 4> q{0, 0, 0, 1};    // x, y, z, w
    std::string frame = "bonemill_device";  // of the header
};

class RobotNode {
  public:
    static constexpr char kNamespace[] = "lab/robot";

    // It writes nothing yet.
    explicit RobotNode(uint32_t domain);
    ~RobotNode();

    // From now on it goes there, in a straight line at this speed (m/s) from where it is.
    void goTo(const ServoPose& pose, double speed = 1e9);
    void beSilent() { is_silent_ = true; }
    void press(const std::vector<int32_t>& buttons);

    // The newest measured_cf (N, N·m); zeros before the first.
    std::array<double, 6> wrench();
    // The newest operating_state; empty before the first.
    std::string state();

  private:
    void run(const std::stop_token& stop);
    void step();

    FastNode node_;
    FastNode::Writer servo_cp_, joy_;
    FastNode::Reader measured_cf_, operating_state_;
    std::array<double, 6> wrench_{};
    std::string state_;
    std::atomic<bool> is_silent_{true};
    std::mutex mutex_;  // guards what is below
    ServoPose now_, goal_;
    double speed_ = 1;
    std::vector<int32_t> buttons_;
    std::jthread thread_;
};

// The bytes of geometry_msgs/PoseStamped.
std::vector<uint8_t> poseStampedBytes(const ServoPose& pose);

}  // namespace bonemill::test
