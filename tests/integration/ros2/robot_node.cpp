#include "tests/integration/ros2/robot_node.h"

#include <chrono>
#include <cmath>

namespace bonemill::test {
namespace {

constexpr double kStep = 1e-3;  // s

std::string topic(const char* name) {
    return std::string("rt/") + RobotNode::kNamespace + "/" + name;
}

}  // namespace

std::vector<uint8_t> poseStampedBytes(const ServoPose& pose) {
    CdrMaker cdr;
    cdr.i32(0).u32(0).text(pose.frame);
    for (const double value : pose.p) cdr.f64(value);
    for (const double value : pose.q) cdr.f64(value);
    return cdr.bytes();
}

RobotNode::RobotNode(uint32_t domain)
    : node_(domain),
      servo_cp_(node_.writer(topic("servo_cp"), "geometry_msgs::msg::dds_::PoseStamped_")),
      joy_(node_.writer(topic("buttons"), "sensor_msgs::msg::dds_::Joy_")),
      measured_cf_(
          node_.read(topic("measured_cf"), "geometry_msgs::msg::dds_::WrenchStamped_", {.depth = 100})),
      operating_state_(node_.read(topic("operating_state"), "crtk_msgs::msg::dds_::OperatingState_")),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

RobotNode::~RobotNode() {
    thread_.request_stop();
    thread_.join();
}

void RobotNode::goTo(const ServoPose& pose, double speed) {
    const std::lock_guard lock(mutex_);
    goal_ = pose;
    speed_ = speed;
    is_silent_ = false;
}

void RobotNode::press(const std::vector<int32_t>& buttons) {
    const std::lock_guard lock(mutex_);
    buttons_ = buttons;
}

void RobotNode::run(const std::stop_token& stop) {
    auto next = std::chrono::steady_clock::now();
    for (int n = 0; !stop.stop_requested(); ++n) {
        std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
        step();
        const std::lock_guard lock(mutex_);
        if (n % 20 != 0 || buttons_.empty()) continue;
        CdrMaker cdr;
        cdr.i32(0).u32(0).text("").u32(0).u32(uint32_t(buttons_.size()));
        for (const int32_t button : buttons_) cdr.i32(button);
        joy_.write(cdr.bytes());
    }
}

void RobotNode::step() {
    if (is_silent_) return;
    const std::lock_guard lock(mutex_);
    std::array<double, 3> way{};
    double length = 0;
    for (size_t i = 0; i < 3; ++i) way[i] = goal_.p[i] - now_.p[i], length = std::hypot(length, way[i]);
    const double share = length > speed_ * kStep ? speed_ * kStep / length : 1;
    const std::array<double, 3> before = now_.p;
    now_ = goal_;
    if (share < 1)
        for (size_t i = 0; i < 3; ++i) now_.p[i] = before[i] + share * way[i];
    servo_cp_.write(poseStampedBytes(now_));
}

std::array<double, 6> RobotNode::wrench() {
    for (const auto& bytes : measured_cf_.take()) {
        CdrBytes cdr(bytes);
        cdr.i32(), cdr.u32(), cdr.text();
        for (double& value : wrench_) value = cdr.f64();
    }
    return wrench_;
}

std::string RobotNode::state() {
    for (const auto& bytes : operating_state_.take()) {
        CdrBytes cdr(bytes);
        cdr.i32(), cdr.u32(), cdr.text();
        state_ = cdr.text();
    }
    return state_;
}

}  // namespace bonemill::test
