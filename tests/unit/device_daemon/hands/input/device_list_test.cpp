// The list says of every kind of device whether it can be used, or why not and what to do.
#include "device_daemon/hands/input/device_list.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bonemill {
namespace {

ListedDevice entryOf(const DeviceFacts& facts, const std::string& kind) {
    const auto entries = listDevices(facts);
    const auto found = std::ranges::find(entries, kind, &ListedDevice::kind);
    EXPECT_NE(found, entries.end()) << kind;
    return found != entries.end() ? *found : ListedDevice{};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

const UsbFact kSpaceMouse{
    .vendor = 0x256f, .product = 0xc635, .path = "/dev/bus/usb/001/004", .name = "SpaceMouse"};
const UsbFact kOmega{.vendor = 0x1451, .product = 0x0402, .path = "/dev/bus/usb/001/005", .name = "omega.6"};

TEST(DeviceList, WithNothingPluggedInEverythingButTheMouseSaysWhyNot) {
    for (const ListedDevice& entry : listDevices({})) {
        EXPECT_EQ(entry.usable, entry.kind == "mouse") << entry.kind;
        EXPECT_EQ(entry.why_not.empty(), entry.usable) << entry.kind;
    }
    EXPECT_EQ(entryOf({}, "mouse").what_to_type, "device_daemon --scene FILE --device pointer");
    for (const char* kind :
         {"Force Dimension", "Novint Falcon", "Touch", "SpaceMouse", "gamepad", "pedal or keys"})
        EXPECT_FALSE(entryOf({}, kind).why_not.empty()) << kind;
}

TEST(DeviceList, ASpaceMouseWithoutSpacenavdSaysWhatToInstall) {
    const ListedDevice entry = entryOf({.usb = {kSpaceMouse}, .spnav = SpnavState::kNoSocket}, "SpaceMouse");
    EXPECT_FALSE(entry.usable);
    EXPECT_TRUE(contains(entry.why_not, "spacenavd does not run"));
    EXPECT_TRUE(contains(entry.what_to_type, "apt install spacenavd"));
}

TEST(DeviceList, ASpaceMouseIsReadyWhenSpacenavdHasIt) {
    const ListedDevice entry =
        entryOf({.spnav_path = "/run/spnav.sock", .spnav = SpnavState::kReady}, "SpaceMouse");
    EXPECT_TRUE(entry.usable);
    EXPECT_EQ(entry.what_to_type, "device_daemon --scene FILE --device spacemouse");
    EXPECT_TRUE(contains(entryOf({.spnav = SpnavState::kNoDevice}, "SpaceMouse").why_not,
                         "no SpaceMouse is plugged"));
    for (const SpnavState state : {SpnavState::kSilent, SpnavState::kForbidden})
        EXPECT_FALSE(entryOf({.spnav = state}, "SpaceMouse").what_to_type.empty());
}

TEST(DeviceList, LogitechsMiceAreNoSpaceMice) {
    const UsbFact mouse{.vendor = 0x046d, .product = 0xc077, .name = "M105"};
    EXPECT_TRUE(entryOf({.usb = {mouse}}, "SpaceMouse").name.empty());
    const UsbFact navigator{.vendor = 0x046d, .product = 0xc626, .name = "SpaceNavigator"};
    EXPECT_EQ(entryOf({.usb = {mouse, navigator}}, "SpaceMouse").name, "SpaceNavigator");
}

TEST(DeviceList, AForbiddenPedalSaysWhichRuleToInstall) {
    const InputFact pedal{.path = "/dev/input/event7", .name = "FootSwitch", .role = InputRole::kKeyboard};
    const InputFact pad{
        .path = "/dev/input/event9", .name = "pad", .role = InputRole::kGamepad, .may_read = true};
    const DeviceFacts facts{.inputs = {pedal, pad}};
    const ListedDevice entry = entryOf(facts, "pedal or keys");
    EXPECT_FALSE(entry.usable);
    EXPECT_TRUE(contains(entry.what_to_type, "deploy/udev/60-bonemill.rules"));
    EXPECT_EQ(entryOf(facts, "gamepad").what_to_type,
              "device_daemon --scene FILE --device gamepad:/dev/input/event9");
    EXPECT_TRUE(entryOf(facts, "gamepad").usable);
    EXPECT_TRUE(contains(entryOf({.inputs = {pad}}, "pedal or keys").why_not, "no pedal"));
}

TEST(DeviceList, AnArmNeedsPermissionAndItsLibrary) {
    UsbFact omega = kOmega;
    EXPECT_TRUE(contains(entryOf({.usb = {omega}}, "Force Dimension").what_to_type, "60-bonemill.rules"));
    omega.may_write = true;
    ArmLibraries libraries;
    libraries.force_dimension.why_not = "no such file";
    const ListedDevice without = entryOf({.usb = {omega}, .libraries = libraries}, "Force Dimension");
    EXPECT_TRUE(contains(without.why_not, "libdrd.so.3 cannot be loaded: no such file"));
    libraries.force_dimension.loads = true;
    EXPECT_TRUE(entryOf({.usb = {omega}, .libraries = libraries}, "Force Dimension").usable);
    const UsbFact serial_adapter{.vendor = 0x0403, .product = 0x6001, .may_write = true};
    EXPECT_FALSE(entryOf({.usb = {serial_adapter}, .libraries = libraries}, "Novint Falcon").usable);
    const UsbFact falcon{.vendor = 0x0403, .product = 0xcb48, .may_write = true};
    EXPECT_TRUE(entryOf({.usb = {falcon}, .libraries = libraries}, "Novint Falcon").usable);
    libraries.open_haptics.loads = true;
    for (const auto& [vendor, product] : {std::pair(0x0301, 0x2988), std::pair(0x2988, 0x0302)}) {
        const UsbFact touch{.vendor = uint16_t(vendor), .product = uint16_t(product), .may_write = true};
        EXPECT_TRUE(entryOf({.usb = {touch}, .libraries = libraries}, "Touch").usable);
    }
}

TEST(DeviceTable, IsForATerminal) {
    const std::vector<ListedDevice> devices{
        {.kind = "gamepad",
         .name = "pad",
         .path = "/dev/input/event9",
         .usable = true,
         .what_to_type = "use it"},
        {.kind = "SpaceMouse", .name = "Space\x1b[31m", .why_not = "it is asleep", .what_to_type = "wake it"},
        {.kind = "Touch", .why_not = "none is on USB"}};
    EXPECT_EQ(deviceTable(devices),
              "gamepad          ready      pad  /dev/input/event9\n"
              "                 type       use it\n"
              "SpaceMouse       not ready  it is asleep\n"
              "                            Space?[31m\n"
              "                 type       wake it\n"
              "Touch            not ready  none is on USB\n");
}

TEST(DeviceList, ThisMachineCanBeAsked) {
    const auto entries = listDevices(gatherDeviceFacts({}));
    EXPECT_GE(entries.size(), 7u);
    EXPECT_FALSE(deviceTable(entries).empty());
}

}  // namespace
}  // namespace bonemill
