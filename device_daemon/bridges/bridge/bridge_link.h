// The arm's end of the wire: what the arm says in a period goes to the host as a state, and what the host
// commands comes back as a wrench that the arm may give.
//
// step() runs on the arm's thread; leave() and the questions below it are for any other.
#pragma once

#include <atomic>
#include <optional>

#include "common/base/units.h"
#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/force_gate.h"

namespace bonemill::bridge {

class BridgeLink : public ArmPeriod {
  public:
    // Throws UserError if the address cannot be used.
    BridgeLink(const ArmDescription& arm, const wire::Endpoint& local,
               const std::optional<wire::Endpoint>& only_host = {});

    ArmOrder step(const ArmReading& reading, int64_t now_ns) noexcept override;

    wire::Endpoint local() const noexcept { return link_.local(); }
    // Asks for the end: the wrench fades, and the host hears that the bridge leaves in order.
    void leave() noexcept { shall_leave_ = true; }
    bool hasLeft() const noexcept { return has_left_; }
    // The arm has not answered for kLostNs.
    bool isArmLost() const noexcept { return is_arm_lost_; }
    // The number of the arm's complaint, for people.
    uint32_t faultCode() const noexcept { return fault_code_; }
    int64_t lastStepNs() const noexcept { return last_step_ns_; }

    // A vendor's call that fails once or a few times is forgiven: the wrench fades meanwhile. After
    // kTroubleNs it is a fault of the device, and after kLostNs the arm is lost.
    static constexpr int64_t kTroubleNs = 20 * kNsPerMillisecond;
    static constexpr int64_t kLostNs = 1500 * kNsPerMillisecond;
    // The host's "off" counts when it lasts: after the reset of a fault it says so for a moment.
    static constexpr int64_t kOffAfterNs = 50 * kNsPerMillisecond;

  private:
    uint32_t faultsOf(const ArmReading& reading, int64_t now_ns) noexcept;
    bool isDriving(int64_t now_ns) noexcept;
    std::optional<Wrench> wanted(const ArmReading& reading, int64_t now_ns) const noexcept;
    void sendState(const ArmReading& reading, int64_t now_ns) noexcept;

    wire::ControllerLink<wire::PosePackets> link_;
    ForceGate gate_;
    Pose X_DT_;
    bool has_pose_ = false;
    int64_t good_ns_ = 0;  // when the arm was last well
    bool is_in_trouble_ = false;
    bool is_driving_ = false;
    int64_t on_ns_ = 0;  // when the host last did not want the motors off
    int64_t before_ns_ = 0;

    // Each is a lone word between two threads.
    std::atomic<bool> shall_leave_{false};
    std::atomic<bool> has_left_{false};
    std::atomic<bool> is_arm_lost_{false};
    std::atomic<uint32_t> fault_code_{0};
    std::atomic<int64_t> last_step_ns_{0};
};

}  // namespace bonemill::bridge
