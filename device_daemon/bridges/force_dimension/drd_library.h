// The functions of Force Dimension's SDK 3 that the bridge calls, found at run time in libdrd.so.3, which
// holds the dhd functions, too. The declarations are ours; nothing of the SDK is here.
//
// A call returns 0, kDhdTimeguard (nothing new since the last read) or kDhdMotorSaturated, which are all
// successes, or -1, with the reason in dhdErrorGetLast of the same thread. Arms are named by a char, 0
// for the first.
#pragma once

#include <string>

#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/vendor_device.h"

namespace bonemill::bridge {

inline constexpr int kDhdTimeguard = 1;
inline constexpr int kDhdMotorSaturated = 2;
constexpr bool isDhdSuccess(int result) noexcept {
    return result == 0 || result == kDhdTimeguard || result == kDhdMotorSaturated;
}

// Places in dhdGetStatus' array. SDK versions write 12 to 17 of them.
inline constexpr int kStatusLength = 32;
enum DhdStatus { kDhdPower = 0, kDhdConnected = 1, kDhdReset = 3, kDhdForce = 5, kDhdForceOffCause = 14 };
enum DhdForceOffCause { kOffByButton = 1, kOffByVelocity = 2, kOffByDeadMan = 6 };

class DrdLibrary {
  public:
    // Loads it from --library, FDSDK, FORCEDIM_SDK, ~/.local/lib, /usr/local/lib or where the dynamic linker
    // looks, and says what it has found. Throws UserError.
    DrdLibrary(const std::string& chosen, const Tell& tell);

    // These are always there. They have the vendor's names.
    // NOLINTBEGIN(readability-identifier-naming)
    void (*dhdGetSDKVersion)(int*, int*, int*, int*) = nullptr;
    int (*dhdGetDeviceCount)() = nullptr;
    int (*dhdOpenID)(char) = nullptr;
    int (*dhdClose)(char) = nullptr;
    int (*dhdGetSystemType)(char) = nullptr;
    int (*dhdGetStatus)(int*, char) = nullptr;
    int (*dhdGetPosition)(double*, double*, double*, char) = nullptr;
    int (*dhdSetForceAndTorqueAndGripperForce)(double, double, double, double, double, double, double,
                                               char) = nullptr;
    int (*dhdEnableForce)(unsigned char, char) = nullptr;
    int (*dhdStop)(char) = nullptr;
    int (*dhdErrorGetLast)() = nullptr;
    const char* (*dhdErrorGetLastStr)() = nullptr;

    // These are null in SDKs that lack them.
    int (*dhdGetPositionAndOrientationFrame)(double*, double*, double*, double (*)[3], char) = nullptr;
    bool (*dhdHasWrist)(char) = nullptr;
    bool (*dhdHasActiveWrist)(char) = nullptr;
    bool (*dhdHasGripper)(char) = nullptr;
    unsigned (*dhdGetButtonMask)(char) = nullptr;
    int (*dhdEmulateButton)(unsigned char, char) = nullptr;
    int (*dhdGetSerialNumber)(unsigned short*, char) = nullptr;
    const char* (*dhdGetSystemName)(char) = nullptr;
    double (*dhdGetMaxForce)(char) = nullptr;
    double (*dhdGetMaxTorque)(char) = nullptr;
    int (*drdOpenID)(char) = nullptr;
    int (*drdClose)(char) = nullptr;
    bool (*drdIsInitialized)(char) = nullptr;
    // NOLINTEND(readability-identifier-naming)

    // Opens and closes with drd where there is one, which its calibration asks for.
    int openArm(char id) { return drdOpenID ? drdOpenID(id) : dhdOpenID(id); }
    int closeArm(char id) { return drdOpenID && drdClose ? drdClose(id) : dhdClose(id); }
    std::string lastError() const;

  private:
    void findFunctions();
    void checkVersion(const Tell& tell) const;

    SharedLibrary library_;
};

}  // namespace bonemill::bridge
