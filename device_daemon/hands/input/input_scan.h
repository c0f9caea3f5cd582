// Asks udev which input and USB devices are plugged in.
//
// It makes system calls and allocates; it is not for the loop.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

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

// In the order of their paths in /sys, which is that of the sockets they are plugged into.
std::vector<InputFact> scanInputs();
std::vector<UsbFact> scanUsb();

}  // namespace bonemill
