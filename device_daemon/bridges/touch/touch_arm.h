// A Touch or Phantom of 3D Systems through OpenHaptics HD: the library has the clock and calls us about 1000
// times a second, on a thread of its own.
//
// It gives force only, and never torque. Not verified on hardware (docs/howto/bridges.md).
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/bridge/vendor_device.h"

namespace bonemill::bridge {

// The functions of 3D Systems' OpenHaptics HD that the bridge calls, found at run time in libHD.so. The
// declarations and numbers are ours, after the manual; nothing of the library is here.
//
// Positions are mm in x to the right, y up, z towards the user. hdGet* and hdSet* belong between hdBeginFrame
// and hdEndFrame, on the library's own thread. Errors pile up: hdGetError takes the newest first.
using HdDevice = unsigned;
using HdEnum = unsigned;
inline constexpr HdDevice kHdNoDevice = 0xffffffffu;

struct HdErrorInfo {
    unsigned code;
    int internal;
    HdDevice device;
};

enum HdParameter : HdEnum {
    kHdCurrentButtons = 0x2000,    // int, bit 0 in front
    kHdCurrentTransform = 0x2052,  // 16 doubles by columns, mm
    kHdModelType = 0x2501,
    kHdDriverVersion = 0x2502,
    kHdSerialNumber = 0x2504,
    kHdUsableWorkspace = 0x2551,  // 6 doubles, mm: lowest x y z, highest x y z
    kHdInputDof = 0x2553,
    kHdCalibrationStyle = 0x2555,
    kHdNominalMaxForce = 0x2603,   // N
    kHdMotorTemperature = 0x2605,  // 3 or 6 doubles, 0 to 1
    kHdCurrentForce = 0x2700,      // N
    kHdForceOutput = 0x4000,       // for hdEnable
};
enum HdCalibration : HdEnum {
    kHdCalibrationOk = 0x5000,
    kHdNeedsUpdate = 0x5001,
    kHdNeedsManualInput = 0x5002
};
enum HdError : unsigned {
    kHdWarmMotors = 0x0200,
    kHdExceededForce = 0x0201,
    kHdExceededImpulse = 0x0202,
    kHdExceededVelocity = 0x0203,
    kHdForceError = 0x0204,
};
inline constexpr unsigned kHdCallbackContinue = 1;
inline constexpr unsigned short kHdMaxPriority = 0xffff;

class HdLibrary {
  public:
    // Loads it and says what it has found. Throws UserError.
    HdLibrary(const std::string& chosen, const Tell& tell);

    // They have the vendor's names.
    // NOLINTBEGIN(readability-identifier-naming)
    HdDevice (*hdInitDevice)(const char*) = nullptr;
    void (*hdDisableDevice)(HdDevice) = nullptr;
    void (*hdMakeCurrentDevice)(HdDevice) = nullptr;
    void (*hdBeginFrame)(HdDevice) = nullptr;
    void (*hdEndFrame)(HdDevice) = nullptr;
    void (*hdEnable)(HdEnum) = nullptr;
    void (*hdDisable)(HdEnum) = nullptr;
    void (*hdGetIntegerv)(HdEnum, int*) = nullptr;
    void (*hdGetDoublev)(HdEnum, double*) = nullptr;
    void (*hdSetDoublev)(HdEnum, const double*) = nullptr;
    const char* (*hdGetString)(HdEnum) = nullptr;
    HdErrorInfo (*hdGetError)() = nullptr;
    const char* (*hdGetErrorString)(unsigned) = nullptr;
    HdEnum (*hdCheckCalibration)() = nullptr;
    void (*hdUpdateCalibration)(HdEnum) = nullptr;
    void (*hdStartScheduler)() = nullptr;
    void (*hdStopScheduler)() = nullptr;
    unsigned long (*hdScheduleAsynchronous)(unsigned (*)(void*), void*, unsigned short) = nullptr;
    void (*hdUnschedule)(unsigned long) = nullptr;
    // NOLINTEND(readability-identifier-naming)

    // Takes all errors that have piled up and returns the oldest, which led to the others; 0 if there is
    // none.
    unsigned takeErrors() noexcept;
    std::string textOf(unsigned error) const;

  private:
    SharedLibrary library_;
};

// Takes the library's axes to D.
inline const Eigen::Matrix3d kTouchAxes{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};

class TouchArm : public Arm {
  public:
    explicit TouchArm(const BridgeOptions& options) : options_(options) {}
    ~TouchArm() override { stop(); }

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    void openDevice();
    ArmDescription describe();
    // The rest is the library's thread.
    static unsigned onTick(void* arm) noexcept;
    void tick() noexcept;
    ArmReading read() noexcept;
    void readPose(ArmReading& reading) noexcept;
    void readCondition() noexcept;
    void write(const ArmOrder& order) noexcept;
    void takeErrors() noexcept;

    const BridgeOptions options_;
    std::optional<HdLibrary> hd_;
    Tell tell_;
    HdDevice device_ = kHdNoDevice;
    Eigen::Vector3d middle_V_ = Eigen::Vector3d::Zero();  // of the workspace, m
    bool has_orientation_ = false;
    unsigned long schedule_ = 0;
    bool is_scheduled_ = false;

    std::atomic<ArmPeriod*> period_{nullptr};
    std::atomic<bool> shall_end_{false};
    std::atomic<bool> has_ended_{false};  // the last tick has taken the force away

    // Of the library's thread.
    ArmReading last_;  // calibration, faults and temperature go on from tick to tick
    bool is_driving_ = false;
    unsigned error_ = 0;
    uint64_t ticks_ = 0;
};

}  // namespace bonemill::bridge
