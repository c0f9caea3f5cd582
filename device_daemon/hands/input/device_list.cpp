#include "device_daemon/hands/input/device_list.h"

#include <libudev.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
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

constexpr const char* kInstallRules =
    "sudo cp deploy/udev/60-bonemill.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
    "sudo udevadm trigger";

constexpr uint16_t k3Dconnexion = 0x256f;
// Older models have Logitech's number, as mice and gamepads do.
constexpr uint16_t kLogitech = 0x046d;
constexpr std::array<uint16_t, 13> kOlderSpaceMice{0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626,
                                                   0xc627, 0xc628, 0xc629, 0xc62b, 0xc62e, 0xc640};

bool isSpaceMouse(const UsbFact& usb) {
    return usb.vendor == k3Dconnexion ||
           (usb.vendor == kLogitech && std::ranges::count(kOlderSpaceMice, usb.product) > 0);
}

struct ArmKind {
    const char* kind;
    const char* device;  // of --device
    bool (*is_it)(const UsbFact&);
    ArmLibrary ArmLibraries::*library;
    const char* library_name;
};

constexpr std::array<ArmKind, 3> kArms{{
    {"Force Dimension", "force-dimension", [](const UsbFact& usb) { return usb.vendor == 0x1451; },
     &ArmLibraries::force_dimension, "libdrd.so.3"},
    {"Novint Falcon", "force-dimension",
     [](const UsbFact& usb) { return usb.vendor == 0x0403 && usb.product == 0xcb48; },
     &ArmLibraries::force_dimension, "libdrd.so.3"},
    {"Touch", "touch",
     [](const UsbFact& usb) {
         return (usb.vendor == 0x0301 && usb.product == 0x2988) ||
                (usb.vendor == 0x2988 && usb.product == 0x0302);
     },
     &ArmLibraries::open_haptics, "libHD.so"},
}};

std::string use(const std::string& device) {
    return "device_daemon --scene FILE --device " + device;
}

ListedDevice spaceMouse(const DeviceFacts& facts) {
    const auto usb = std::ranges::find_if(facts.usb, isSpaceMouse);
    const bool is_seen = usb != facts.usb.end();
    ListedDevice entry{.kind = "SpaceMouse", .name = is_seen ? usb->name : "", .path = facts.spnav_path};
    switch (facts.spnav) {
        case SpnavState::kReady:
            entry.usable = true;
            entry.word = "spacemouse";
            entry.what_to_type = use(entry.word);
            break;
        case SpnavState::kNoDevice:
            entry.why_not = is_seen ? "it is on USB, and spacenavd has not opened it"
                                    : "spacenavd runs, and no SpaceMouse is plugged in";
            if (is_seen) entry.what_to_type = "sudo systemctl restart spacenavd";
            break;
        case SpnavState::kNoSocket:
            entry.why_not = is_seen ? "it is on USB, and spacenavd does not run"
                                    : "no SpaceMouse is on USB, and spacenavd does not run";
            if (is_seen)
                entry.what_to_type = "sudo apt install spacenavd && sudo systemctl restart spacenavd";
            break;
        case SpnavState::kSilent:
            entry.why_not = "nobody answers on spacenavd's socket";
            entry.what_to_type = "sudo systemctl restart spacenavd";
            break;
        case SpnavState::kForbidden:
            entry.why_not = "you may not open spacenavd's socket";
            entry.what_to_type = "sudo chmod a+rw " + facts.spnav_path;
            break;
    }
    return entry;
}

struct InputWords {
    const char* kind;
    const char* option;  // takes the path
    const char* word;    // of --device, takes the path; empty for what is no hand
    const char* none;
};

// Appends those of the role, or why there are none.
void listInputs(const DeviceFacts& facts, InputRole role, const InputWords& words,
                std::vector<ListedDevice>& entries) {
    const size_t before = entries.size();
    for (const InputFact& input : facts.inputs) {
        if (input.role != role) continue;
        ListedDevice entry{
            .kind = words.kind, .name = input.name, .path = input.path, .usable = input.may_read};
        entry.why_not = input.may_read ? "" : "you may not read it";
        entry.what_to_type = input.may_read ? words.option + input.path : kInstallRules;
        if (input.may_read && *words.word) entry.word = words.word + input.path;
        entries.push_back(entry);
    }
    if (entries.size() > before) return;
    entries.push_back({.kind = words.kind,
                       .why_not = facts.inputs.empty() ? "this machine has no input devices" : words.none});
}

ListedDevice armOf(const ArmKind& arm, const UsbFact& usb, const ArmLibraries& libraries) {
    const ArmLibrary& library = libraries.*arm.library;
    ListedDevice entry{.kind = arm.kind, .name = usb.name, .path = usb.path};
    if (!usb.may_write) {
        entry.why_not = "you may not write to it";
        entry.what_to_type = kInstallRules;
    } else if (!library.loads) {
        entry.why_not = std::string("the vendor's library ") + arm.library_name + " cannot be loaded";
        if (!library.why_not.empty()) entry.why_not += ": " + library.why_not;
    } else {
        entry.usable = true;
        entry.word = arm.device;
        entry.what_to_type = use(entry.word);
    }
    return entry;
}

void listArms(const DeviceFacts& facts, std::vector<ListedDevice>& entries) {
    for (const ArmKind& arm : kArms) {
        const size_t before = entries.size();
        for (const UsbFact& usb : facts.usb) {
            if (arm.is_it(usb)) entries.push_back(armOf(arm, usb, facts.libraries));
        }
        if (entries.size() == before) entries.push_back({.kind = arm.kind, .why_not = "none is on USB"});
    }
}

// Bytes beyond ASCII stay: they are letters in UTF-8.
std::string printable(std::string text) {
    for (char& c : text) {
        if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
    }
    return text;
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

DeviceFacts gatherDeviceFacts(const ArmLibraries& libraries) {
    const std::string path = spnavSocketPath();
    return {.usb = scanUsb(),
            .inputs = scanInputs(),
            .spnav_path = path,
            .spnav = probeSpnav(path),
            .libraries = libraries};
}

std::vector<ListedDevice> listDevices(const DeviceFacts& facts) {
    std::vector<ListedDevice> entries;
    listArms(facts, entries);
    entries.push_back(spaceMouse(facts));
    listInputs(facts, InputRole::kGamepad,
               {.kind = "gamepad",
                .option = "device_daemon --scene FILE --device gamepad:",
                .word = "gamepad:",
                .none = "none is plugged in"},
               entries);
    entries.push_back({.kind = "mouse",
                       .name = "in a viewer's window",
                       .usable = true,
                       .word = "pointer",
                       .what_to_type = use("pointer")});
    listInputs(facts, InputRole::kKeyboard,
               {.kind = "pedal or keys",
                .option = "device_daemon --scene FILE --pedal ",
                .word = "",
                .none = "no pedal and no keyboard is plugged in"},
               entries);
    return entries;
}

std::string deviceTable(std::span<const ListedDevice> devices) {
    constexpr int kKindWidth = 17, kStateWidth = 11;
    std::string table;
    const auto addLine = [&](const std::string& left, const char* state, const std::string& text) {
        std::array<char, 64> columns;
        std::snprintf(columns.data(), columns.size(), "%-*s%-*s", kKindWidth, left.c_str(), kStateWidth,
                      state);
        table += columns.data() + printable(text) + "\n";
    };
    for (const ListedDevice& device : devices) {
        const std::string gap = device.name.empty() || device.path.empty() ? "" : "  ";
        const std::string who = device.name + gap + device.path;
        addLine(device.kind, device.usable ? "ready" : "not ready", device.usable ? who : device.why_not);
        if (!device.usable && !who.empty()) addLine("", "", who);
        if (!device.what_to_type.empty()) addLine("", "type", device.what_to_type);
    }
    return table;
}

}  // namespace bonemill
