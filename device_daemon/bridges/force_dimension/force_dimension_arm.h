// An arm of Force Dimension, or a Falcon, through their SDK: a thread of ours calls it once in each period.
//
// Axes of the SDK: x towards the operator, y to the right, z up. Not verified on hardware
// (docs/howto/bridges.md).
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "common/rt/realtime.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/force_dimension/drd_library.h"

namespace bonemill::bridge {

// What is known of Force Dimension's arms by the type that the SDK reports, as published with the open
// CHAI3D; the SDK itself does not say how strong an arm is.
struct SystemType {
    int type;
    const char* name;
    double max_force;         // N
    double max_torque;        // N·m; 0 for arms whose wrist has no motors
    double max_stiffness;     // N/m
    double workspace_radius;  // m
};

// An arm that is not in the table gets the limits of the weakest that is.
SystemType systemTypeOf(int type) noexcept;

// Takes the SDK's axes to D.
inline const Eigen::Matrix3d kForceDimensionAxes{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};

class ForceDimensionArm : public Arm {
  public:
    explicit ForceDimensionArm(const BridgeOptions& options) : options_(options) {}
    ~ForceDimensionArm() override { stop(); }

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    void openArm();
    ArmDescription describe() const;
    // The rest is the loop's thread.
    void run(ArmPeriod& period) noexcept;
    ArmReading read() noexcept;
    bool readPose(ArmReading& reading) noexcept;
    void readStatus() noexcept;
    void write(const ArmOrder& order) noexcept;
    void release() noexcept;
    void check(int result) noexcept;

    const BridgeOptions options_;
    Tell tell_;
    std::optional<DrdLibrary> sdk_;
    SystemType type_{};
    bool has_wrist_ = false;
    char id_ = 0;
    bool is_open_ = false;

    std::atomic<bool> shall_end_{false};
    std::atomic<bool> has_ended_{false};
    RealtimeThread thread_;
    bool has_thread_ = false;

    // Of the loop's thread.
    ArmReading last_;  // status, faults and buttons go on from period to period
    bool is_driving_ = false;
    bool has_failed_ = false;  // a call since the last reading
    uint32_t last_error_ = 0;  // dhdErrorGetLast of it
    uint64_t periods_ = 0;
};

}  // namespace bonemill::bridge
