// Input and USB devices of a testbed of umockdev, as the kernel and udev would show them: they are found,
// opened, asked, heard and shaken.
#include <gtest/gtest.h>
#include <linux/uinput.h>
#include <stdlib.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>

#include "device_daemon/hands/input/device_list.h"
#include "device_daemon/hands/input/gamepad_device.h"
#include "device_daemon/hands/input/pedal_source.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::bytesOf;
using test::comesTrue;

constexpr const char* kPad = "/dev/input/event5";
constexpr const char* kPedal = "/dev/input/event6";

// In the words of umockdev-record; "\n" in it is that of a file in /sys.
constexpr const char* kDevices = R"(P: /devices/pci0/usb1/1-1
N: bus/usb/001/002
E: DEVNAME=/dev/bus/usb/001/002
E: DEVTYPE=usb_device
E: SUBSYSTEM=usb
A: idVendor=256f\n
A: idProduct=c635\n
A: product=SpaceMouse Compact\n

P: /devices/pci0/usb1/1-2/input/input5
E: SUBSYSTEM=input
A: name=Test Pad\n

P: /devices/pci0/usb1/1-2/input/input5/event5
N: input/event5
E: DEVNAME=/dev/input/event5
E: SUBSYSTEM=input
E: ID_INPUT_JOYSTICK=1
E: ID_BUS=usb

P: /devices/pci0/usb1/1-3/input/input6
E: SUBSYSTEM=input
A: name=Foot Switch\n

P: /devices/pci0/usb1/1-3/input/input6/event6
N: input/event6
E: DEVNAME=/dev/input/event6
E: SUBSYSTEM=input
E: ID_INPUT_KEY=1
E: ID_INPUT_KEYBOARD=1
E: ID_BUS=usb

P: /devices/pci0/usb1/1-4/input/input7
E: SUBSYSTEM=input
A: name=Mouse\n

P: /devices/pci0/usb1/1-4/input/input7/event7
N: input/event7
E: DEVNAME=/dev/input/event7
E: SUBSYSTEM=input
E: ID_INPUT_KEY=1
E: ID_INPUT_MOUSE=1
E: ID_BUS=usb
)";

// Answers as the kernel does for a pad with one stick, one button and rumble.
class KernelPad {
  public:
    KernelPad() : handler_(umockdev_ioctl_base_new()) {
        g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&KernelPad::handle), this);
    }
    ~KernelPad() { g_object_unref(handler_); }
    UMockdevIoctlBase* handler() const { return handler_; }

    void hold(int key) { held_key_ = key; }
    ff_effect effect() const {
        const std::scoped_lock lock(mutex_);
        return effect_;
    }
    int uploads() const { return uploads_; }

  private:
    static gboolean handle(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
        static_cast<KernelPad*>(self)->answer(client);
        return TRUE;
    }

    void answer(UMockdevIoctlClient* client) {
        const unsigned long request = umockdev_ioctl_client_get_request(client);
        std::vector<uint8_t> bytes(_IOC_SIZE(request));
        UMockdevIoctlData* const argument =
            bytes.empty() ? nullptr
                          : umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0,
                                                        bytes.size(), nullptr);
        if (argument) std::memcpy(bytes.data(), argument->data, bytes.size());
        const int result = fill(request, bytes);
        if (argument && result >= 0)
            umockdev_ioctl_data_update(argument, 0, bytes.data(), static_cast<int>(bytes.size()));
        umockdev_ioctl_client_complete(client, result, result < 0 ? EINVAL : 0);
    }

    int fill(unsigned long request, std::vector<uint8_t>& bytes) {
        const auto setBit = [&](size_t bit) { bytes.at(bit / 8) |= static_cast<uint8_t>(1u << (bit % 8)); };
        const unsigned number = _IOC_NR(request);
        if (request == EVIOCSFF) {
            const std::scoped_lock lock(mutex_);
            std::memcpy(&effect_, bytes.data(), sizeof effect_);
            effect_.id = 3;
            std::memcpy(bytes.data(), &effect_, sizeof effect_);
            ++uploads_;
        } else if (number == _IOC_NR(EVIOCGNAME(0))) {
            std::fill(bytes.begin(), bytes.end(), uint8_t(0));
            std::strcpy(reinterpret_cast<char*>(bytes.data()), "Test Pad");
        } else if (number == _IOC_NR(EVIOCGKEY(0))) {
            std::fill(bytes.begin(), bytes.end(), uint8_t(0));
            if (const int key = held_key_) setBit(static_cast<size_t>(key));
        } else if (number == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) {
            setBit(ABS_X);
        } else if (number == _IOC_NR(EVIOCGBIT(EV_FF, 0))) {
            setBit(FF_RUMBLE);
        } else if (number == _IOC_NR(EVIOCGABS(ABS_X))) {
            const input_absinfo axis{
                .value = 5, .minimum = -100, .maximum = 100, .fuzz = 0, .flat = 0, .resolution = 0};
            std::memcpy(bytes.data(), &axis, sizeof axis);
        } else {
            return -1;
        }
        return 0;
    }

    UMockdevIoctlBase* const handler_;
    mutable std::mutex mutex_;
    ff_effect effect_{};
    std::atomic<int> uploads_ = 0;
    std::atomic<int> held_key_ = 0;
};

// umockdev shows its devices to programs that were started with its library in front of the C library.
void startAnewInTestbed() {
    if (getenv("BONEMILL_IN_TESTBED")) return;
    std::ifstream file("/proc/self/cmdline");
    std::string words((std::istreambuf_iterator<char>(file)), {});
    std::vector<char*> arguments;
    for (size_t at = 0; at < words.size(); at += std::strlen(&words[at]) + 1) arguments.push_back(&words[at]);
    arguments.push_back(nullptr);
    setenv("BONEMILL_IN_TESTBED", "1", 1);
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
    execv("/proc/self/exe", arguments.data());
}

class UdevTest : public testing::Test {
  protected:
    static void SetUpTestSuite() { startAnewInTestbed(); }

    UdevTest() : testbed(umockdev_testbed_new()) {
        EXPECT_TRUE(umockdev_testbed_add_from_string(testbed, kDevices, nullptr));
        EXPECT_TRUE(umockdev_testbed_attach_ioctl(testbed, kPad, pad.handler(), nullptr));
        EXPECT_TRUE(umockdev_testbed_attach_ioctl(testbed, kPedal, pad.handler(), nullptr));
    }
    ~UdevTest() override { g_object_unref(testbed); }

    void send(const char* device, int type, int code, int value) {
        const int file = umockdev_testbed_get_dev_fd(testbed, device);
        for (const input_event& event :
             {test::inputEvent(type, code, value), test::inputEvent(EV_SYN, SYN_REPORT, 0)})
            ASSERT_EQ(write(file, &event, sizeof event), ssize_t(sizeof event));
    }

    KernelPad pad;
    UMockdevTestbed* const testbed;
};

TEST_F(UdevTest, FindsWhatIsPluggedIn) {
    const auto inputs = scanInputs();
    ASSERT_EQ(inputs.size(), 3u);
    EXPECT_EQ(inputs[0].name, "Test Pad");
    EXPECT_EQ(inputs[0].path, kPad);
    EXPECT_EQ(inputs[0].role, InputRole::kGamepad);
    EXPECT_TRUE(inputs[0].may_read);
    EXPECT_EQ(inputs[1].role, InputRole::kKeyboard);
    EXPECT_EQ(inputs[2].role, InputRole::kOther);
    const auto usb = scanUsb();
    ASSERT_EQ(usb.size(), 1u);
    EXPECT_EQ(usb[0].vendor, 0x256f);
    EXPECT_EQ(usb[0].product, 0xc635);
    EXPECT_EQ(usb[0].name, "SpaceMouse Compact");
    EXPECT_EQ(usb[0].path, "/dev/bus/usb/001/002");
}

TEST_F(UdevTest, OpensTheGamepadAndAsksWhatItIsLike) {
    const auto device = gamepadAt()();
    ASSERT_TRUE(device);
    EXPECT_EQ(device->name, "Test Pad");
    EXPECT_TRUE(device->has_rumble);
    EXPECT_TRUE(device->state.axes[ABS_X].exists());
    EXPECT_EQ(device->state.axes[ABS_X].value, 5);
    EXPECT_FALSE(device->state.axes[ABS_Y].exists());
    EXPECT_TRUE(device->state.keys.none());
    pad.hold(BTN_EAST);
    EvdevState state;
    EXPECT_TRUE(refreshEvdev(device->file, state));
    EXPECT_TRUE(state.keys[BTN_EAST]);
    EXPECT_EQ(state.keys.count(), 1u);
    close(device->file);
}

TEST_F(UdevTest, AfterDroppedEventsTheGamepadIsAskedWhatItHolds) {
    GamepadDevice device(RateConfig{}, Pose{});
    DeviceReading reading;
    ASSERT_TRUE(comesTrue([&] { return device.read(0, reading); }));
    pad.hold(BTN_EAST);
    send(kPad, EV_SYN, SYN_DROPPED, 0);
    EXPECT_TRUE(comesTrue([&] { return device.read(0, reading) && reading.buttons == kButtonAdd; }));
}

TEST_F(UdevTest, TheGamepadShakesWithTheForce) {
    GamepadDevice device(RateConfig{}, Pose{});
    DeviceReading reading;
    ASSERT_TRUE(comesTrue([&] { return device.read(0, reading); }));
    EXPECT_EQ(pad.uploads(), 0);
    const DeviceOrder order{.wrench_hand_D = {{0, 0, 4}, {0, 0, 0}}, .is_wanted = true, .is_engaged = true};
    device.write(order);
    ASSERT_TRUE(comesTrue([&] { return pad.uploads() > 0; }));
    EXPECT_EQ(pad.effect().type, FF_RUMBLE);
    EXPECT_EQ(pad.effect().u.rumble.strong_magnitude, rumbleOf(4, false).strong);
    send(kPad, EV_KEY, BTN_SOUTH, 1);
    ASSERT_TRUE(comesTrue([&] { return device.read(0, reading) && reading.buttons == kButtonRemove; }));
    EXPECT_TRUE(comesTrue([&] { return pad.effect().u.rumble.weak_magnitude == rumbleOf(4, true).weak; }));
    // It goes on as long as the force does, and ends with it.
    const int before = pad.uploads();
    EXPECT_TRUE(comesTrue([&] { return pad.uploads() > before + 1; }));
    send(kPad, EV_KEY, BTN_SOUTH, 0);
    ASSERT_TRUE(comesTrue([&] { return device.read(0, reading) && reading.buttons == 0; }));
    device.write({});
    EXPECT_TRUE(comesTrue([&] { return pad.effect().u.rumble.strong_magnitude == 0; }));
}

TEST_F(UdevTest, HearsThePedal) {
    const PedalSource pedal([] { return openEvdev(kPedal, false); });
    ASSERT_TRUE(comesTrue([&] { return pedal.isThere(); }));
    send(kPedal, EV_KEY, KEY_B, 1);
    EXPECT_TRUE(comesTrue([&] { return pedal.buttons() == kButtonRemove; }));
}

TEST_F(UdevTest, TheListShowsThem) {
    const std::string table = deviceTable(listDevices(gatherDeviceFacts({})));
    for (const char* part :
         {"Test Pad  /dev/input/event5", "--device gamepad:/dev/input/event5",
          "Foot Switch  /dev/input/event6", "--pedal /dev/input/event6", "SpaceMouse Compact"})
        EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
}

}  // namespace
}  // namespace bonemill
