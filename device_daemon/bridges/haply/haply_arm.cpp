#include "device_daemon/bridges/haply/haply_arm.h"

#include <chrono>
#include <cstdlib>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "device_daemon/bridges/bridge/axes.h"
#include "device_daemon/bridges/bridge/bridge_main.h"

namespace bonemill::bridge {
namespace {

constexpr std::chrono::seconds kConnectTime{3};
constexpr int64_t kSendNs = 20 * kNsPerMillisecond;
constexpr int64_t kInventoryNs = 2 * kNsPerSecond;
constexpr int64_t kAnswerNs = 5 * kNsPerMillisecond;     // so long a period waits
constexpr int64_t kAskAgainNs = 10 * kNsPerMillisecond;  // then the answer is not coming
// The service does not say how strong its arms are.
constexpr double kCautiousForce = 5;      // N
constexpr double kInverse3Radius = 0.10;  // m
constexpr double kMinverseRadius = 0.04;

}  // namespace

ArmDescription HaplyArm::open(const Tell& tell) {
    tell_ = tell;
    const auto dialect = dialectOf(haply_.version);
    if (!dialect) throw UserError("--service-version " + haply_.version + ": give it as 3.5");
    dialect_ = *dialect;
    connect();
    takeInventory();
    ArmDescription description;
    description.name = "Haply " + (state_.type.empty() ? "arm" : state_.type);
    description.serial = std::strtoull(state_.device_id.c_str(), nullptr, 16);
    description.kind = DeviceKind::kHaply;
    description.has_orientation = !state_.grip_id.empty();
    description.max_force = kCautiousForce;
    description.workspace_radius = state_.type == "minverse" ? kMinverseRadius : kInverse3Radius;
    return description;
}

void HaplyArm::connect() {
    try {
        socket_.emplace(WebTarget{.host = haply_.host, .port = haply_.port, .is_plain = true},
                        WebSocketRequest{.is_text = true, .refusal = "it opens none"}, kConnectTime);
    } catch (const UserError& error) {
        throw UserError(std::string("library: no WebSocket at ") + error.what() +
                        ". Install Haply's Inverse Service and see that it runs (systemctl status "
                        "haply-inverse-service), or name its port with --service-port.");
    }
    tell_("service: ws://" + haply_.host + ":" + std::to_string(haply_.port) + ", taken as version " +
          haply_.version);
}

// The service begins with a list of all that it has.
void HaplyArm::takeInventory() {
    if (!receive(monotonicNowNs() + kInventoryNs) || !takeMessage(message_, options_.device, state_))
        throw UserError("library: the service sends no list of its devices; is port " +
                        std::to_string(haply_.port) + " its simulation channel?");
    if (!state_.is_there)
        throw UserError(
            options_.device.empty()
                ? "device: the service has no arm. Plug it in; /var/log/haply-inverse-service tells more."
                : "device: the service has no arm " + options_.device);
    if (!state_.is_calibrated) tell_("the arm is not calibrated: until then it gives no force");
}

void HaplyArm::start(ArmPeriod& period) {
    thread_ = startArmLoop(options_, tell_, [this, &period] { run(period); });
    has_thread_ = true;
}

void HaplyArm::stop() noexcept {
    shall_end_ = true;
    if (has_thread_) thread_.join();
    has_thread_ = false;
    release();
}

void HaplyArm::run(ArmPeriod& period) noexcept {
    PeriodicTimer timer(kPeriodNs, monotonicNowNs());
    ArmOrder order;
    while (!shall_end_) {
        timer.waitNext();
        const bool has_answered = exchange(order);
        order = period.step(read(has_answered), monotonicNowNs());
    }
}

// Until the host has enabled operation once, the arm is asked and nothing is commanded. From then on a force
// is, if only zero.
bool HaplyArm::exchange(const ArmOrder& order) {
    const int64_t now_ns = monotonicNowNs();
    if (unanswered_since_ns_ == 0 || now_ns - unanswered_since_ns_ > kAskAgainNs) {
        if (!send(nextMessage(order))) return false;
        unanswered_since_ns_ = now_ns;
    }
    bool is_understood = false;
    // Of answers that came late, the newest counts.
    for (int64_t deadline_ns = now_ns + kAnswerNs; receive(deadline_ns); deadline_ns = 0) {
        unanswered_since_ns_ = 0;
        is_understood = takeMessage(message_, options_.device, state_);
    }
    return is_understood;
}

// Puts a message into the socket; false if that has ended, or did not take it within a moment.
bool HaplyArm::send(const std::string& message) {
    if (!socket_->hasUnsent()) socket_->send(message);
    const int64_t deadline_ns = monotonicNowNs() + kSendNs;
    for (socket_->move(); socket_->hasUnsent() && !socket_->hasEnded(); socket_->move()) {
        const int64_t left_ns = deadline_ns - monotonicNowNs();
        if (left_ns <= 0) return false;
        socket_->wait(-1, std::chrono::nanoseconds(left_ns));
    }
    return !socket_->hasEnded();
}

// Waits for a whole message until the deadline (CLOCK_MONOTONIC ns).
bool HaplyArm::receive(int64_t deadline_ns) {
    socket_->move();
    while (!socket_->receive(message_)) {
        const int64_t left_ns = deadline_ns - monotonicNowNs();
        if (left_ns <= 0 || socket_->hasEnded()) return false;
        socket_->wait(-1, std::chrono::nanoseconds(left_ns));
        socket_->move();
    }
    return true;
}

std::string HaplyArm::nextMessage(const ArmOrder& order) {
    const bool is_first = !has_spoken_;
    has_spoken_ = true;
    has_driven_ |= order.is_driving;
    if (is_first || !has_driven_) return probeMessage(state_, dialect_, is_first);
    return forceMessage(state_, dialect_, wrenchInV(kHaplyAxes, order.wrench_D).force);
}

ArmReading HaplyArm::read(bool has_answered) const noexcept {
    ArmReading reading;
    const bool has_turn = state_.R_V && state_.R_V->coeffs().allFinite() && state_.R_V->norm() > 0.5;
    const Eigen::Quaterniond turn = has_turn ? state_.R_V->normalized() : Eigen::Quaterniond::Identity();
    reading.is_valid = has_answered && state_.is_there && state_.p_V && state_.p_V->allFinite() &&
                       (state_.grip_id.empty() || has_turn);
    reading.has_failed = !has_answered;
    if (reading.is_valid) {
        const Eigen::Vector3d origin_V = Eigen::Vector3d(haply_.origin_mm.data()) * kMillimetre;
        reading.X_DT = poseInD(kHaplyAxes, *state_.p_V - origin_V, turn);
    }
    // A grip's angular velocity is not in the messages, and half a velocity is of no use.
    reading.has_velocity = state_.v_V && state_.v_V->allFinite() && state_.grip_id.empty();
    if (reading.has_velocity) reading.v_DT = kHaplyAxes * *state_.v_V;
    reading.buttons = (state_.button_a ? kButtonRemove : 0u) | (state_.button_b ? kButtonAdd : 0u);
    reading.is_homed = state_.is_calibrated;
    reading.is_powered = state_.has_power && state_.is_ready;
    return reading;
}

// The service lets go of an arm that is not commanded.
void HaplyArm::release() noexcept {
    if (!socket_) return;
    if (has_driven_) {
        const std::string zero = forceMessage(state_, dialect_, Eigen::Vector3d::Zero());
        // send() only drains what still waits from before.
        if (!socket_->hasUnsent() || send(zero)) send(zero);
    }
    socket_.reset();
}

}  // namespace bonemill::bridge
