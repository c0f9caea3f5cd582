#include "device_daemon/apps/device_daemon/found_devices.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "device_daemon/apps/device_daemon/child_program.h"

namespace bonemill {
namespace {

// A library that hangs must not hold the list.
constexpr char kProbe[] = "timeout --signal=KILL 5 ";

std::string quotedForShell(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

// Asks a bridge whether its vendor's library is there.
ArmLibrary libraryOf(const std::string& bridge) {
    std::string path;
    try {
        path = programPath(bridge);
    } catch (const std::exception& error) {
        return {.loads = false, .why_not = error.what()};
    }
    FILE* const output = popen((kProbe + quotedForShell(path) + " --probe 2>&1 >/dev/null").c_str(), "r");
    if (!output) return {.loads = false, .why_not = "no process for " + bridge};
    char line[512] = "";
    std::string first;
    while (std::fgets(line, sizeof(line), output))
        if (first.empty()) first = line;
    const int status = pclose(output);
    while (!first.empty() && (first.back() == '\n' || first.back() == ' ')) first.pop_back();
    if (first.rfind("error: ", 0) == 0) first.erase(0, 7);
    return {.loads = status == 0, .why_not = status == 0 ? "" : first};
}

}  // namespace

std::vector<ListedDevice> foundDevices() {
    return listDevices(gatherDeviceFacts({.force_dimension = libraryOf("bonemill_bridge_force_dimension"),
                                          .open_haptics = libraryOf("bonemill_bridge_touch")}));
}

std::string bestOf(const std::vector<ListedDevice>& devices) {
    for (const ListedDevice& device : devices)
        if (device.usable && !device.word.empty()) return device.word;
    return "pointer";
}

}  // namespace bonemill
