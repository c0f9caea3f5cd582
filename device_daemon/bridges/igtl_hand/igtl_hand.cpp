#include "device_daemon/bridges/igtl_hand/igtl_hand.h"

#include <sstream>

#include "common/base/user_error.h"
#include "common/igtl_wire/igtl_messages.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "common/tcp/listen.h"
#include "device_daemon/bridges/bridge/axes.h"

namespace bonemill::bridge {
namespace {

constexpr std::chrono::milliseconds kLook{20};
constexpr size_t kMostWaiting = 8 << 10;  // bytes: a wrench behind more would be old
constexpr const char* kButtonsDevice = "bonemill_buttons";
constexpr double kFarthest = 10;      // m
constexpr double kCautiousForce = 5;  // N, where nobody says what the peer can give

}  // namespace

Eigen::Matrix3d axesOf(const std::string& text) {
    const auto fail = [&] {
        return UserError("--axes " + text +
                         ": name the peer's axes that are D's x, y and z, right-handed, as -y,x,z");
    };
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
    std::istringstream words(text);
    std::string word;
    int row = 0;
    for (; std::getline(words, word, ','); ++row) {
        const bool is_negative = word.starts_with('-');
        const std::string name = word.substr(is_negative ? 1 : 0);
        if (row > 2 || name.size() != 1 || name[0] < 'x' || name[0] > 'z') throw fail();
        axes(row, name[0] - 'x') = is_negative ? -1 : 1;
    }
    if (row != 3 || axes.determinant() < 0.5) throw fail();
    return axes;
}

ArmDescription IgtlHand::open(const Tell& tell) {
    tell_ = tell;
    R_DP_ = axesOf(hand_.axes);
    if (hand_.peer.empty() && !isLoopback(hand_.address))
        throw UserError("--igtl-address " + hand_.address +
                        ": whoever reaches it could move the tool; say with --peer which address may");
    port_.emplace(hand_.address, hand_.port, std::vector{igtl::kWantedTransform, igtl::kWantedString},
                  igtl::PortBounds{.most_lines = 4}, static_cast<igtl::LineSink&>(*this));
    tell_("hands come by OpenIGTLink to " + hand_.address + ":" + std::to_string(port_->number()));
    ArmDescription description;
    description.name = "OpenIGTLink";
    description.has_orientation = !hand_.is_place_only;
    description.max_force = kCautiousForce;
    description.max_torque = hand_.max_torque;
    description.workspace_radius = hand_.workspace_mm * kMillimetre;
    return description;
}

void IgtlHand::start(ArmPeriod& period) {
    listener_ = std::thread([this] { listen(); });
    loop_ = startArmLoop(options_, tell_, [this, &period] { run(period); });
    has_loop_ = true;
}

void IgtlHand::stop() noexcept {
    shall_end_ = true;
    if (has_loop_) loop_.join();
    has_loop_ = false;
    if (listener_.joinable()) listener_.join();
    port_.reset();
}

void IgtlHand::listen() noexcept {
    while (!shall_end_) port_->step(kLook);
}

void IgtlHand::run(ArmPeriod& period) noexcept {
    PeriodicTimer timer(kPeriodNs, monotonicNowNs());
    PacedHand hand;
    HeardPose heard;
    while (!shall_end_) {
        timer.waitNext();
        heard_.tryRead(heard);
        const int64_t now_ns = monotonicNowNs();
        const ArmOrder order = period.step(hand.step(heard, now_ns), now_ns);
        const Wrench wrench = wrenchInV(R_DP_, order.wrench_D);
        wrench_P_.write({wrench.force.x(), wrench.force.y(), wrench.force.z(), wrench.torque.x(),
                         wrench.torque.y(), wrench.torque.z()});
    }
}

void IgtlHand::came(igtl::Line& line) {
    const bool may_come = hand_.peer.empty() ? line.isOfThisPc() : textOf(line.from()) == hand_.peer;
    if (!may_come) line.refuse("it may not hold the hand");
}

void IgtlHand::heard(igtl::Line& line, const igtl::Frame& frame) {
    frame.type == "STRING" ? hearButtons(line, frame) : hearPose(line, frame);
}

// Words of what the hand presses: "remove", "add", both or none.
void IgtlHand::hearButtons(const igtl::Line& line, const igtl::Frame& frame) {
    const auto text = igtl::stringOf(frame.body);
    if (frame.device != kButtonsDevice || line.number() != holder_ || !text) return;
    newest_.buttons = 0;
    std::istringstream words(*text);
    for (std::string word; words >> word;)
        newest_.buttons |= word == "remove" ? kButtonRemove : word == "add" ? kButtonAdd : 0u;
    heard_.write(newest_);
}

// The first who says where the hand is holds it until its line ends.
void IgtlHand::hearPose(igtl::Line& line, const igtl::Frame& frame) {
    if (!hand_.device.empty() && frame.device != hand_.device) return;
    if (holder_ != 0 && holder_ != line.number()) return;
    const auto X_PT = igtl::transformOf(frame.body);
    if (!X_PT) return;
    const std::optional<Eigen::Quaterniond> rotation = hand_.is_place_only
                                                           ? std::optional(Eigen::Quaterniond::Identity())
                                                           : repairedRotation(X_PT->linear());
    if (!rotation) return;
    const Eigen::Vector3d p_P = (X_PT->translation() - Eigen::Vector3d(hand_.origin_mm.data())) * kMillimetre;
    if (p_P.norm() > kFarthest) return;
    if (holder_ == 0) ++newest_.hold;
    holder_ = line.number();
    const Pose X_DT = poseInD(R_DP_, p_P, *rotation);
    newest_.p_D = {X_DT.position.x(), X_DT.position.y(), X_DT.position.z()};
    newest_.q_D = {X_DT.rotation.w(), X_DT.rotation.x(), X_DT.rotation.y(), X_DT.rotation.z()};
    newest_.heard_ns = monotonicNowNs();
    newest_.is_held = true;
    ++newest_.count;
    heard_.write(newest_);
    std::array<double, 6> wrench{};
    wrench_P_.tryRead(wrench);
    const int64_t unix_ns =
        std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
    line.say(std::make_shared<const std::string>(igtl::numbersFrame("bonemill_wrench", unix_ns, wrench)),
             kMostWaiting);
}

void IgtlHand::gone(const igtl::Line& line) {
    if (line.number() != holder_) return;
    holder_ = 0;
    newest_.is_held = false;
    newest_.buttons = 0;
    heard_.write(newest_);
}

}  // namespace bonemill::bridge
