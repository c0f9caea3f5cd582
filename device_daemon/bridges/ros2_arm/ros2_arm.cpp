#include "device_daemon/bridges/ros2_arm/ros2_arm.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"

namespace bonemill::bridge {
namespace {

constexpr char kDefaultNamespace[] = "hand";
// What a program does with the wrench is not known: less than any of the arms would bear.
constexpr double kCautiousForce = 10;    // N
constexpr double kCautiousTorque = 0.5;  // N·m
constexpr double kReach = 1;             // m, of a robot on a table
constexpr int64_t kStateAgainNs = 100 * kNsPerMillisecond;

int64_t unixNowNs() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::string nameOf(const std::string& name_space) {
    return ("ROS 2 /" + name_space).substr(0, sizeof(DeviceCapabilities::name) - 1);
}

}  // namespace

Ros2Arm::Topics::Topics(const ros2::RosOptions& ros, const std::string& name_space)
    : participant(ros2::joinRos(ros)),
      servo_cp(participant, name_space + "/servo_cp"),
      buttons(participant, name_space + "/buttons"),
      measured_cf(participant, name_space + "/measured_cf"),
      operating_state(participant, name_space + "/operating_state") {}

Ros2Arm::Ros2Arm(const BridgeOptions& options, const ros2::RosOptions& ros)
    : options_(options),
      ros_(ros),
      name_space_(ros2::requireNamespace(options.device.empty() ? kDefaultNamespace : options.device)) {}

ArmDescription Ros2Arm::open(const Tell& tell) {
    topics_.emplace(ros_, name_space_);
    tell("topics: /" + name_space_ + "/servo_cp and /" + name_space_ + "/buttons, in ROS domain " +
         std::to_string(ros_.domain) +
         (ros2::isLocalhostOnly() ? " of this PC" : ": whoever is in it may lead the hand"));
    ArmDescription description;
    description.name = nameOf(name_space_);
    description.kind = DeviceKind::kBridge;
    description.has_orientation = true;
    description.max_force = kCautiousForce;
    description.max_torque = kCautiousTorque;
    description.workspace_radius = kReach;
    return description;
}

void Ros2Arm::start(ArmPeriod& period) {
    thread_ = startArmLoop(
        options_, [](const std::string&) {}, [this, &period] { run(period); });
    has_thread_ = true;
}

void Ros2Arm::stop() noexcept {
    shall_end_ = true;
    if (has_thread_) thread_.join();
    has_thread_ = false;
    if (topics_) say({}, monotonicNowNs());
    topics_.reset();
}

void Ros2Arm::run(ArmPeriod& period) noexcept {
    PeriodicTimer timer(kPeriodNs, monotonicNowNs());
    while (!shall_end_) {
        timer.waitNext();
        const int64_t now_ns = monotonicNowNs();
        hear(now_ns);
        say(period.step(hand_.reading(now_ns), now_ns), now_ns);
    }
}

void Ros2Arm::hear(int64_t now_ns) {
    topics_->servo_cp.take([&](const ros2::PoseStamped& message, const dds::SampleInfo& info) {
        hand_.take(message, info.writer, now_ns);
    });
    complain();
    topics_->buttons.take(
        [&](const ros2::Joy& message, const dds::SampleInfo&) { hand_.take(message, now_ns); });
}

// Each once: whoever wrote it has to change something.
void Ros2Arm::complain() {
    if (hand_.foreignFrames() > 0 && !std::exchange(has_named_frame_, true))
        spdlog::warn("a servo_cp does not count: its frame_id should be {}, or empty", ros2::kDeviceFrame);
    if (hand_.foreignHands() > 0 && !std::exchange(has_named_hand_, true))
        spdlog::warn("a second node writes /{}/servo_cp: the first one is followed", name_space_);
}

// The states are CRTK's.
void Ros2Arm::say(const ArmOrder& order, int64_t now_ns) {
    const int64_t stamp_ns = unixNowNs();
    topics_->measured_cf.write(ros2::wrenchOf(stamp_ns, ros2::kDeviceFrame, order.wrench_D));
    const bool is_homed = hand_.reading(now_ns).is_homed;
    const char* const state = is_homed && !hand_.isFresh(now_ns) ? "FAULT"
                              : order.is_driving                 ? "ENABLED"
                                                                 : "DISABLED";
    if (state == state_ && now_ns - said_ns_ < kStateAgainNs) return;
    state_ = state;
    said_ns_ = now_ns;
    topics_->operating_state.write(
        {ros2::headerOf(stamp_ns, ros2::kDeviceFrame), ros2::textOf(state), is_homed, false});
}

}  // namespace bonemill::bridge
