// Looks for a vendor's devices on USB, so that "no device" becomes "not plugged in", "no permission" or
// "another user has it".
//
// It reads /sys, opens nothing, and is for start-up only.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace bonemill::bridge {

struct UsbId {
    const char* vendor;   // "1451", as /sys writes it
    const char* product;  // "" for all of the vendor's
};

struct UsbDevice {
    std::string id;                                // "1451:0402"
    std::vector<std::filesystem::path> nodes;      // /dev/bus/usb/001/004, /dev/ttyACM0, /dev/hidraw1
    std::vector<std::filesystem::path> forbidden;  // those of them that this user may not read and write
};

// `root` has sys and dev; tests have one of their own.
std::vector<UsbDevice> findUsb(std::span<const UsbId> ids, const std::filesystem::path& root = "/");

// Says in a sentence why a library that works sees no device.
std::string whyNoDevice(const std::vector<UsbDevice>& found, const std::string& what);

}  // namespace bonemill::bridge
