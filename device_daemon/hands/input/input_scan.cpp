#include "device_daemon/hands/input/input_scan.h"

#include <libudev.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <string_view>

namespace bonemill {
namespace {

struct Unref {
    void operator()(udev* context) const { udev_unref(context); }
    void operator()(udev_device* device) const { udev_device_unref(device); }
    void operator()(udev_enumerate* list) const { udev_enumerate_unref(list); }
};

std::string textOf(const char* text) {
    return text ? text : "";
}

uint16_t hexadecimalOf(const char* text) {
    return text ? static_cast<uint16_t>(std::strtoul(text, nullptr, 16)) : 0;
}

// Calls `visit` with each device of the subsystem that has a file; `sysname` may have a star.
template <class Visit>
void forEachDevice(const char* subsystem, const char* sysname, const Visit& visit) {
    const std::unique_ptr<udev, Unref> context(udev_new());
    if (!context) return;
    const std::unique_ptr<udev_enumerate, Unref> list(udev_enumerate_new(context.get()));
    if (!list) return;
    udev_enumerate_add_match_subsystem(list.get(), subsystem);
    udev_enumerate_add_match_sysname(list.get(), sysname);
    udev_enumerate_scan_devices(list.get());
    for (udev_list_entry* entry = udev_enumerate_get_list_entry(list.get()); entry;
         entry = udev_list_entry_get_next(entry)) {
        const std::unique_ptr<udev_device, Unref> device(
            udev_device_new_from_syspath(context.get(), udev_list_entry_get_name(entry)));
        if (device && udev_device_get_devnode(device.get())) visit(device.get());
    }
}

bool hasProperty(udev_device* device, const char* name) {
    const char* value = udev_device_get_property_value(device, name);
    return value && std::string_view(value) == "1";
}

InputRole roleOf(udev_device* device) {
    if (hasProperty(device, "ID_INPUT_JOYSTICK")) return InputRole::kGamepad;
    const bool is_keyboard = hasProperty(device, "ID_INPUT_KEYBOARD");
    // A pedal with buttons only has keys, as a computer's power button does, which is not on USB.
    const bool is_usb = textOf(udev_device_get_property_value(device, "ID_BUS")) == "usb";
    const bool has_keys = hasProperty(device, "ID_INPUT_KEY");
    const bool is_mouse = hasProperty(device, "ID_INPUT_MOUSE");
    return is_keyboard || (has_keys && is_usb && !is_mouse) ? InputRole::kKeyboard : InputRole::kOther;
}

}  // namespace

std::vector<InputFact> scanInputs() {
    std::vector<InputFact> facts;
    forEachDevice("input", "event*", [&](udev_device* device) {
        InputFact fact;
        fact.path = udev_device_get_devnode(device);
        if (udev_device* parent = udev_device_get_parent(device))
            fact.name = textOf(udev_device_get_sysattr_value(parent, "name"));
        fact.role = roleOf(device);
        fact.may_read = access(fact.path.c_str(), R_OK) == 0;
        facts.push_back(fact);
    });
    return facts;
}

std::vector<UsbFact> scanUsb() {
    std::vector<UsbFact> facts;
    forEachDevice("usb", "*", [&](udev_device* device) {
        const char* vendor = udev_device_get_sysattr_value(device, "idVendor");
        if (!vendor) return;
        UsbFact fact;
        fact.vendor = hexadecimalOf(vendor);
        fact.product = hexadecimalOf(udev_device_get_sysattr_value(device, "idProduct"));
        fact.path = udev_device_get_devnode(device);
        fact.name = textOf(udev_device_get_sysattr_value(device, "product"));
        fact.may_write = access(fact.path.c_str(), R_OK | W_OK) == 0;
        facts.push_back(fact);
    });
    return facts;
}

}  // namespace bonemill
