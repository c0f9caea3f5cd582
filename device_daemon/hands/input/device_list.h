// What could be the hand of this simulator on this machine, and what is missing for it: device_daemon --list.
//
// It makes system calls and allocates; it is not for the loop.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "device_daemon/hands/input/input_scan.h"
#include "device_daemon/hands/input/spnav_socket.h"

namespace bonemill {

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
