// This is any device whose own program, a bridge, speaks poses and wrenches over the UDP wire
// (docs/reference/ares_link.md).
//
// read() returns false for a pose that is none and after a pose that jumped (PoseGuard); status, buttons,
// fault and motors' load of the reading are filled all the same, and its pose is not. Of a silent bridge
// nothing is, and of one that says what are no numbers the fault alone.
//
// Making one throws UserError. Everything else is RT-safe but for the socket's system calls; one thread uses
// it.
#pragma once

#include <cstdint>
#include <utility>

#include "common/device_messages/device_messages.h"
#include "common/geometry/pose.h"
#include "device_daemon/ares/driver/udp_device.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// Decides whether the pose that a bridge says may be believed, and remembers why not. What is no pose at all
// is refused as long as it is none. After a jump nothing is believed, however well it looks, until a user
// orders a reset or the arm calibrates anew: the same as for ARES (position_guard.h). Before calibration the
// handle may be anywhere, and nothing is a jump.
class PoseGuard {
  public:
    // No hand moves a handle faster. A bridge stamps a pose when it gets it, which may be a fraction of a
    // period late: the slack is for that.
    static constexpr double kLargestSpeed = 5;     // m/s
    static constexpr double kLargestSpin = 60;     // rad/s
    static constexpr double kSlack = 2e-3;         // m
    static constexpr double kAngularSlack = 0.05;  // rad

    // Takes the next pose, read at `stamp_ns` of the bridge's own clock. Of its numbers no more is known than
    // that they are finite; the quaternion may have any length. True says that it may be believed.
    bool take(const Pose& X_DT, int64_t stamp_ns, bool is_calibrated) noexcept;
    // The next pose may be anywhere: it is another session's, and perhaps another clock's. What was refused
    // for a jump stays so.
    void restart() noexcept { has_last_ = false; }
    // Gives the poses another chance, from wherever the handle is now.
    void reset() noexcept;

    // Says why the last pose was refused; kNone where it was believed, and before calibration.
    StopCause cause() const noexcept { return cause_; }

  private:
    bool hasJumped(const Pose& X_DT, int64_t stamp_ns) const noexcept;

    bool has_last_ = false;
    Pose X_DT_;  // the last one that was compared
    int64_t stamp_ns_ = 0;
    bool is_distrusted_ = false;  // until a reset
    StopCause cause_ = StopCause::kNone;
};

// This estimates how fast a handle moves, for a device that says only where it is. It is the difference of
// successive poses behind a first-order filter of 50 Hz. A hand moves with less than about 10 Hz, which the
// filter delays by 3 ms. Of a position in steps of 10 µm, sampled at 1 kHz, the plain difference jumps by 10
// mm/s; the filter leaves 3 mm/s.
class PoseDifferentiator {
  public:
    // The handle was there at that time (ns of any clock that runs evenly). After a pause, or when the clock
    // jumps back, it starts from rest.
    void take(const Pose& X_DT, int64_t stamp_ns) noexcept;

    const Eigen::Vector3d& v_DT() const noexcept { return v_DT_; }  // m/s
    const Eigen::Vector3d& w_DT() const noexcept { return w_DT_; }  // rad/s, in D

  private:
    bool has_pose_ = false;
    Pose X_DT_;
    int64_t stamp_ns_ = 0;
    Eigen::Vector3d v_DT_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_DT_ = Eigen::Vector3d::Zero();
};

class UdpPoseDevice final : public HapticDevice {
  public:
    explicit UdpPoseDevice(UdpDeviceConfig config) : device_(std::move(config)) {}

    // Of nothing until the bridge has described itself.
    DeviceCapabilities capabilities() const noexcept override;
    uint32_t capabilitiesVersion() const noexcept override {
        return 1 + device_.session().descriptionCount();
    }
    const char* refusedFigure() const noexcept override { return device_.session().refusedFigure(); }
    bool hasClock() const noexcept override { return true; }
    bool waitForSample(int64_t deadline_ns) noexcept override { return device_.waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override;
    void write(const DeviceOrder& order) noexcept override;

    const wire::HostSession<wire::PosePackets>& session() const noexcept { return device_.session(); }
    wire::Endpoint local() const noexcept { return device_.local(); }

  private:
    bool isBelieved(const wire::PoseState& state, const Pose& X_DT, uint32_t status) noexcept;
    void readMotion(const wire::PoseState& state, DeviceReading& reading) noexcept;

    UdpDevice<wire::PosePackets> device_;
    PoseGuard guard_;
    uint32_t guarded_description_ = 0;  // whose session the guard has seen
    PoseDifferentiator differentiator_;
};

}  // namespace bonemill
