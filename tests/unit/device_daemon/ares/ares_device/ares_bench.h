// Joints for the tests of the ARES device: those of the emulator, with every fault that an encoder can have,
// and joints whose readings are written by hand.
#pragma once

#include <limits>

#include "device_daemon/ares/ares_device/ares_device.h"
#include "device_daemon/ares/driver/ares_emulator.h"

namespace bonemill::test {

inline constexpr double kPeriod = 1e-3;  // s

class FaultyJoints final : public JointDevice {
  public:
    explicit FaultyJoints(JointDevice& sound) : sound_(sound) {}

    bool hasClock() const noexcept override { return false; }
    bool waitForSample(int64_t deadline_ns) noexcept override { return sound_.waitForSample(deadline_ns); }
    bool readJoints(double elapsed, JointReading& reading) noexcept override {
        if (!sound_.readJoints(elapsed, reading)) return false;
        true_q = reading.q;
        if (is_frozen) {
            reading = last_;
        } else {
            reading.q += offset;
            if (stuck_joint >= 0) reading.q[stuck_joint] = last_.q[stuck_joint];
            if (zero_joint >= 0) reading.q[zero_joint] = 0;
            if (bad_joint >= 0) reading.q[bad_joint] = std::numeric_limits<double>::quiet_NaN();
        }
        reading.status = (reading.status | set_status) & ~clear_status;
        last_ = reading;
        return !is_silent;
    }
    void applyForces(const JointOrder& order) noexcept override {
        ordered = order;
        sound_.applyForces(order);
    }

    Vector6d offset = Vector6d::Zero();
    int stuck_joint = -1, zero_joint = -1, bad_joint = -1;
    bool is_frozen = false, is_silent = false;
    uint32_t set_status = 0, clear_status = 0;
    Vector6d true_q = Vector6d::Zero();
    JointOrder ordered;

  private:
    JointDevice& sound_;
    JointReading last_;
};

// The handle stands where it is put.
class PlacedJoints final : public JointDevice {
  public:
    bool hasClock() const noexcept override { return false; }
    bool waitForSample(int64_t) noexcept override { return false; }
    bool readJoints(double, JointReading& reading) noexcept override {
        reading = reading_;
        return true;
    }
    void applyForces(const JointOrder& order) noexcept override { ordered = order; }

    bool place(const Pose& X_DT) {
        reading_.status = kStatusPowered | kStatusCalibrated | kStatusDriving;
        return kinematics_.inverse(X_DT, reading_.q);
    }

    JointOrder ordered;

  private:
    AresKinematics kinematics_;
    JointReading reading_;
};

// The emulator behind its faults, and the device; a period is 1 ms.
class AresBench {
  public:
    explicit AresBench(const OperatorPath& path, const AresDeviceConfig& config = {},
                       const HandImpedance& hand = {})
        : emulator(AresKinematics(config.geometry), {}, hand, path),
          joints(emulator),
          device(joints, startingAt(path.at(0).X_DT, config)) {
        emulator.startScenario();
    }

    bool step(const DeviceOrder& order) {
        const bool is_believed = device.read(kPeriod, reading);
        device.write(order);
        return is_believed;
    }
    // Follows the hand without force; false if a period was refused.
    bool run(double seconds, const DeviceOrder& order) {
        for (int i = 0; i < std::lround(seconds / kPeriod); ++i) {
            if (!step(order)) return false;
        }
        return true;
    }

    AresEmulator emulator;
    FaultyJoints joints;
    AresDevice device;
    DeviceReading reading;

  private:
    static AresDeviceConfig startingAt(const Pose& X_DT_start, AresDeviceConfig config) {
        config.guard.X_DT_start = X_DT_start;
        return config;
    }
};

inline DeviceOrder engaged(const Eigen::Vector3d& force = Eigen::Vector3d::Zero(),
                           const Eigen::Vector3d& torque = Eigen::Vector3d::Zero()) {
    return {.wrench_hand_D = {force, torque}, .is_wanted = true, .is_engaged = true};
}

// A path to and fro through the specified workspace: up, sideways and turned.
inline OperatorPath busyPath(double tremor, int rounds) {
    const Pose places[] = {{{0, 0, 0}, Eigen::Quaterniond::Identity()},
                           {{0.01, 0.005, 0.02}, expRotation({0.2, 0.1, 0})},
                           {{-0.015, 0.01, -0.01}, expRotation({-0.3, 0.2, 0.4})},
                           {{0.02, -0.015, 0.005}, expRotation({0.1, -0.4, -0.3})}};
    std::vector<Waypoint> waypoints;
    for (int i = 0; i <= 4 * rounds; ++i) waypoints.push_back({0.5 * i, places[i % 4], 0});
    return OperatorPath(waypoints, tremor);
}

}  // namespace bonemill::test
