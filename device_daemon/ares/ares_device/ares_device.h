// ARES as a device that a hand holds: the handle's pose out of six slider positions, and six actuator forces
// out of a wrench.
//
// read() believes a pose only if the sensors stand every check of position_guard.h and the pose lies in the
// workspace; otherwise it returns false, and `fault`, `status` and the buttons of the reading are filled all
// the same. They are not if the joints are silent. Before calibration, and while the device homes, it returns
// true with the last pose at rest and without kStatusCalibrated. `applied_D` is the measured answer to the
// share of the ordered wrench that the motors were told to give: what holds the weight and what the soft
// walls push is taken off.
//
// write() sends, while the motors are wanted: what holds the weight and the ordered wrench, always; the soft
// walls, while engaged. The first two go first, and the wrench is scaled to what they leave of each motor.
// The walls fade in and out with the engagement. After a reading that was refused, only the weight is held,
// as at the last pose that was believed. A number that is not finite makes no force at all, and kDeviceFault
// with the code kAresNotFinite in the next reading.
//
// It is RT-safe after construction, for the loop's thread. Units are kg, m, rad, s, N, N·m.
#pragma once

#include "common/geometry/pose.h"
#include "device_daemon/ares/ares_device/position_guard.h"
#include "device_daemon/ares/ares_device/soft_wall.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// The last stop before the motors: what holds the arm and keeps it inside goes first, and the wrench that the
// hand is to feel gets what is left of every motor. Forces are on the sliders, N.
struct LimitedForces {
    Vector6d forces = Vector6d::Zero();
    double wanted_share =
        0;  // of `wanted` in them, 0 to 1: one factor for all six, so that it keeps its direction
    double base_share = 0;  // of `base`, likewise; below 1 only where the base alone is too much
    bool is_finite = true;  // if not, all forces are zero
};

// Returns base + share * wanted with no force beyond `largest`, which must be positive.
LimitedForces limitForces(const Vector6d& base, const Vector6d& wanted, double largest) noexcept;

// The weight of what moves with the handle, for an arm that no counterweight holds. The moving parts count as
// one rigid body on the platform; what the sliders and links weigh must be balanced, or lumped into it.
struct MovingWeight {
    double mass = 0;                                     // kg; 0 for a counterweighted arm
    Eigen::Vector3d centre_T = Eigen::Vector3d::Zero();  // of the mass
    Eigen::Vector3d down_D = -Eigen::Vector3d::UnitZ();  // a unit vector: where things fall to
};

inline constexpr double kStandardGravity = 9.80665;  // m/s²

// Returns the wrench in D, about T's origin, that holds the weight up: the opposite of what gravity does.
Wrench holdingWrench(const MovingWeight& weight, const Pose& X_DT) noexcept;

inline constexpr uint32_t kAresNotFinite = 0xA0000001;  // a fault code: a force was not a number

struct AresDeviceConfig {
    AresGeometry geometry;
    PositionGuardConfig guard;
    MovingWeight weight;
    SoftWallConfig walls;
    double max_actuator_force = 50;  // N
    double max_force = 50;           // N that the hand may count on in any direction
    double max_torque = 1;           // N·m
    HandleDynamics handle = {};
    bool is_simulated = false;  // no hand and no motor behind the joints
    bool has_enabling_switch = false;
};

class AresDevice final : public HapticDevice {
  public:
    // `joints` must outlive the device; the geometry must be buildable.
    AresDevice(JointDevice& joints, const AresDeviceConfig& config) noexcept;

    DeviceCapabilities capabilities() const noexcept override { return capabilities_; }
    bool hasClock() const noexcept override { return joints_.hasClock(); }
    bool waitForSample(int64_t deadline_ns) noexcept override { return joints_.waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override;
    void write(const DeviceOrder& order) noexcept override;

    // Returns the forces that were sent last, and which share of the ordered wrench is in them: below 1 where
    // the motors cannot give all of it.
    const Vector6d& actuatorForces() const noexcept { return sent_.forces; }
    double wrenchShare() const noexcept { return wrench_share_; }
    // Tells whether a soft wall pushes.
    bool touchesWall() const noexcept { return touches_wall_; }

  private:
    // The forces of one write().
    struct Sent {
        Vector6d forces = Vector6d::Zero();
        Vector6d base = Vector6d::Zero();                // of these: weight and walls
        Eigen::Vector3d push = Eigen::Vector3d::Zero();  // N on the hand: what is left of the ordered force
    };
    void fillPose(const JointReading& joints, DeviceReading& reading) const noexcept;
    void fadeWalls(bool is_engaged) noexcept;
    Vector6d wallForces() noexcept;
    Sent compose(const DeviceOrder& order) noexcept;

    JointDevice& joints_;
    AresDeviceConfig config_;
    PositionGuard guard_;
    SoftWall walls_;
    DeviceCapabilities capabilities_;
    Pose X_DT_;  // last believed
    Vector6d twist_D_ = Vector6d::Zero();
    bool has_pose_ = false;                // the last reading was believed
    double elapsed_ = 0;                   // s, of the last read()
    double since_heard_ = 0;               // s, since the joints last answered
    Vector6d holding_ = Vector6d::Zero();  // forces that hold the weight, at the last believed pose
    double walls_share_ = 0;
    bool touches_wall_ = false;
    double wrench_share_ = 0;
    bool was_not_finite_ = false;  // in the last write()
    Sent sent_;
};

}  // namespace bonemill
