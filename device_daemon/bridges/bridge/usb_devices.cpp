#include "device_daemon/bridges/bridge/usb_devices.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "device_daemon/bridges/bridge/shared_library.h"

namespace bonemill::bridge {
namespace {

namespace fs = std::filesystem;

std::string wordIn(const fs::path& file) {
    std::string word;
    std::ifstream(file) >> word;
    return word;
}

int numberIn(const fs::path& file) {
    int number = 0;
    std::ifstream(file) >> number;
    return number;
}

fs::path usbNode(const fs::path& device, const fs::path& root) {
    char name[32];
    std::snprintf(name, sizeof(name), "%03d/%03d", numberIn(device / "busnum"), numberIn(device / "devnum"));
    return root / "dev/bus/usb" / name;
}

// The kernel lists what else serves a device, such as .../tty/ttyACM0 or .../hidraw/hidraw1, a few folders
// below.
void addNodesBelow(const fs::path& folder, const fs::path& root, int depth, std::vector<fs::path>& nodes) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        if (entry.is_symlink(error) || !entry.is_directory(error)) continue;
        const std::string parent = folder.filename().string();
        if (parent == "tty" || parent == "hidraw")
            nodes.push_back(root / "dev" / entry.path().filename());
        else if (depth > 0)
            addNodesBelow(entry.path(), root, depth - 1, nodes);
    }
}

UsbDevice describe(const fs::path& device, const fs::path& root, const std::string& id) {
    constexpr int kDepth = 4;
    UsbDevice found{id, {usbNode(device, root)}, {}};
    addNodesBelow(device, root, kDepth, found.nodes);
    for (const fs::path& node : found.nodes)
        if (access(node.c_str(), R_OK | W_OK) != 0) found.forbidden.push_back(node);
    return found;
}

}  // namespace

std::vector<UsbDevice> findUsb(std::span<const UsbId> ids, const fs::path& root) {
    std::vector<UsbDevice> found;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(root / "sys/bus/usb/devices", error)) {
        const std::string vendor = wordIn(entry.path() / "idVendor");
        const std::string product = wordIn(entry.path() / "idProduct");
        const bool is_wanted = std::any_of(ids.begin(), ids.end(), [&](const UsbId& id) {
            return vendor == id.vendor && (*id.product == 0 || product == id.product);
        });
        if (!is_wanted) continue;
        std::string numbers = vendor;
        numbers.append(":").append(product);
        found.push_back(describe(fs::canonical(entry.path(), error), root, numbers));
    }
    return found;
}

std::string whyNoDevice(const std::vector<UsbDevice>& found, const std::string& what) {
    if (found.empty())
        return "device: no " + what + " is on USB of this PC. Plug it in and switch it on (lsusb lists it).";
    for (const UsbDevice& device : found) {
        if (device.forbidden.empty()) continue;
        std::vector<std::string> nodes;
        for (const fs::path& node : device.forbidden) nodes.push_back(node.string());
        return "permission: " + what + " " + device.id + " is on USB, and this user may not use " +
               joined(nodes) +
               ". Copy deploy/udev/60-bonemill.rules to /etc/udev/rules.d and plug it in again.";
    }
    return "device: " + what + " " + found.front().id +
           " is on USB and may be used, but its library does not see it. Does another program have it?";
}

}  // namespace bonemill::bridge
