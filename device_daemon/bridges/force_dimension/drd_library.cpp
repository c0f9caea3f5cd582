#include "device_daemon/bridges/force_dimension/drd_library.h"

#include <cstdlib>

#include "common/base/user_error.h"

namespace bonemill::bridge {
namespace {

constexpr int kKnownMajor = 3;

std::vector<std::filesystem::path> sdkFolders() {
    std::vector<std::filesystem::path> folders;
    for (const char* name : {"FDSDK", "FORCEDIM_SDK"})
        if (const char* root = std::getenv(name))
            folders.push_back(std::filesystem::path(root) / "lib/release/lin-x86_64-gcc");
    if (const char* home = std::getenv("HOME")) folders.push_back(std::filesystem::path(home) / ".local/lib");
    folders.push_back("/usr/local/lib");
    return folders;
}

LibrarySearch searchFor(const std::string& chosen) {
    return {"libdrd.so.3", "the Force Dimension SDK 3", chosen, false, sdkFolders()};
}

}  // namespace

DrdLibrary::DrdLibrary(const std::string& chosen, const Tell& tell) : library_(searchFor(chosen)) {
    tell("library: " + library_.path());
    findFunctions();
    library_.checkFunctions(tell);
    checkVersion(tell);
}

void DrdLibrary::findFunctions() {
#define REQUIRE(function) library_.require(function, #function)
    REQUIRE(dhdGetSDKVersion);
    REQUIRE(dhdGetDeviceCount);
    REQUIRE(dhdOpenID);
    REQUIRE(dhdClose);
    REQUIRE(dhdGetSystemType);
    REQUIRE(dhdGetStatus);
    REQUIRE(dhdGetPosition);
    REQUIRE(dhdSetForceAndTorqueAndGripperForce);
    REQUIRE(dhdEnableForce);
    REQUIRE(dhdStop);
    REQUIRE(dhdErrorGetLast);
    REQUIRE(dhdErrorGetLastStr);
#undef REQUIRE
#define ALLOW(function) library_.allow(function, #function)
    ALLOW(dhdGetPositionAndOrientationFrame);
    ALLOW(dhdHasWrist);
    ALLOW(dhdHasActiveWrist);
    ALLOW(dhdHasGripper);
    ALLOW(dhdGetButtonMask);
    ALLOW(dhdEmulateButton);
    ALLOW(dhdGetSerialNumber);
    ALLOW(dhdGetSystemName);
    ALLOW(dhdGetMaxForce);
    ALLOW(dhdGetMaxTorque);
    ALLOW(drdOpenID);
    ALLOW(drdClose);
    ALLOW(drdIsInitialized);
#undef ALLOW
}

void DrdLibrary::checkVersion(const Tell& tell) const {
    int version[4] = {};
    dhdGetSDKVersion(&version[0], &version[1], &version[2], &version[3]);
    const std::string text = std::to_string(version[0]) + "." + std::to_string(version[1]) + "." +
                             std::to_string(version[2]) + "." + std::to_string(version[3]);
    tell("SDK version: " + text);
    if (version[0] != kKnownMajor)
        throw UserError("library: " + library_.path() + " is version " + text +
                        " of the SDK; this bridge knows " + std::to_string(kKnownMajor) + ".x only");
}

std::string DrdLibrary::lastError() const {
    const int number = dhdErrorGetLast();
    const char* text = dhdErrorGetLastStr();
    return "error " + std::to_string(number) + ", " + (text ? text : "no text");
}

}  // namespace bonemill::bridge
