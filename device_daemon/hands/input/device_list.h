// What could be the hand of this simulator on this machine, and what is missing for it: device_daemon --list.
//
// It makes system calls and allocates; it is not for the loop.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "device_daemon/hands/input/spnav.h"

namespace bonemill {

enum class InputRole {
    kGamepad,
    kKeyboard,  // or a foot pedal, which is one with few keys
    kOther,
};

struct InputFact {
    std::string path = {};  // /dev/input/event*
    std::string name = {};
    InputRole role = InputRole::kOther;
    bool may_read = false;
};

struct UsbFact {
    uint16_t vendor = 0;
    uint16_t product = 0;
    std::string path = {};  // /dev/bus/usb/*
    std::string name = {};  // of the product, as the device says it
    bool may_write = false;
};

// Ask udev what is plugged in: in the order of their paths in /sys, which is that of the sockets they are
// plugged into.
std::vector<InputFact> scanInputs();
std::vector<UsbFact> scanUsb();

struct ListedDevice {
    std::string kind = {};  // "SpaceMouse"
    std::string name = {};  // as the device says it; empty when there is none
    std::string path = {};
    bool usable = false;
    std::string word = {};          // of --device, when usable
    std::string why_not = {};       // empty when usable
    std::string what_to_type = {};  // to use it, or to make it usable; empty when typing does not help
};

// Whether the library of a vendor can be loaded is found out by who loads it.
struct ArmLibrary {
    bool loads = false;
    std::string why_not;  // empty: not tried
};
struct ArmLibraries {
    ArmLibrary force_dimension;
    ArmLibrary open_haptics;
};

struct DeviceFacts {
    std::vector<UsbFact> usb = {};
    std::vector<InputFact> inputs = {};
    std::string spnav_path = {};
    SpnavState spnav = SpnavState::kNoSocket;
    ArmLibraries libraries = {};
};

DeviceFacts gatherDeviceFacts(const ArmLibraries& libraries);

// Every kind of device has at least one entry.
std::vector<ListedDevice> listDevices(const DeviceFacts& facts);

// Returns lines for a terminal, the last one ended, too. What devices say of themselves cannot steer the
// terminal.
std::string deviceTable(std::span<const ListedDevice> devices);

}  // namespace bonemill
