#include <gtest/gtest.h>

#include "device_daemon/bridges/bridge/vendor_device.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::bridge {
namespace {

constexpr UsbId kIds[] = {{"1451", ""}, {"0301", "2988"}};

// A tree as the kernel's, with one device and what serves it.
class UsbDevicesTest : public testing::Test {
  protected:
    void plugIn(const std::string& vendor, const std::string& product, const std::string& below = "") {
        const auto device = root_.path() / "sys/bus/usb/devices/1-2";
        std::filesystem::create_directories(device / below);
        test::writeFile(device / "idVendor", vendor + "\n");
        test::writeFile(device / "idProduct", product + "\n");
        test::writeFile(device / "busnum", "1\n");
        test::writeFile(device / "devnum", "4\n");
    }
    void addNode(const std::string& name) {
        const auto node = root_.path() / "dev" / name;
        std::filesystem::create_directories(node.parent_path());
        test::writeFile(node, "");
    }
    std::string reason() const { return whyNoDevice(findUsb(kIds, root_.path()), "arm"); }

    test::TemporaryFolder root_;
};

TEST_F(UsbDevicesTest, NothingPluggedIn) {
    plugIn("0403", "6001");
    EXPECT_TRUE(findUsb(kIds, root_.path()).empty());
    EXPECT_TRUE(reason().starts_with("device: no arm is on USB")) << reason();
}

TEST_F(UsbDevicesTest, NoPermissionNamesTheNodeAndTheRule) {
    plugIn("1451", "0402");
    const auto found = findUsb(kIds, root_.path());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].id, "1451:0402");
    EXPECT_TRUE(reason().starts_with("permission: arm 1451:0402")) << reason();
    EXPECT_NE(reason().find("dev/bus/usb/001/004"), std::string::npos) << reason();
    EXPECT_NE(reason().find("60-bonemill.rules"), std::string::npos) << reason();
}

TEST_F(UsbDevicesTest, SerialAndHidNodesCountToo) {
    plugIn("0301", "2988", "1-2:1.0/tty/ttyACM3");
    addNode("bus/usb/001/004");
    EXPECT_NE(reason().find("ttyACM3"), std::string::npos) << reason();
    addNode("ttyACM3");
    EXPECT_TRUE(reason().starts_with("device: arm 0301:2988 is on USB and may be used")) << reason();
}

}  // namespace
}  // namespace bonemill::bridge
