// A live server meets a device whose daemon is this test: it shows the device's state, mills only while it is
// engaged, passes on the order to reset it, and trusts nothing that it says.
#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;
using test::run;
using test::waitFor;

constexpr DeviceCapabilities kTestArm{.name = "test arm",
                                      .kind = uint32_t(DeviceKind::kUnknown),
                                      .abilities = kAbilityForce,
                                      .max_force = 2,
                                      .max_torque = 0,
                                      .max_stiffness = 1000,
                                      .max_rotation_stiffness = 0,
                                      .workspace_radius = 0.1};

// The hand goes down until the burr would be 0.7 mm in the slab, with the pedal down. Its samples come about
// 1000 times per second.
class FakeDevice {
  public:
    FakeDevice()
        : link_(DeviceLink::create(testSession(), LinkSide::kDaemon)),
          thread_([this](const std::stop_token& stop) { live(stop); }) {}

    std::atomic<SafetyState> state{SafetyState::kReady};
    std::atomic<StopCause> cause{StopCause::kNone};
    std::atomic<bool> says_nonsense{false};
    std::atomic<uint32_t> reset_orders{0};
    std::atomic<double> force{0}, torque{0};  // as commanded last

  private:
    void live(const std::stop_token& stop) {
        link_.writeCapabilities(kTestArm);
        double height = 1e-3;  // m
        for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
            DeviceSample sample{};
            sample.stamp_ns = monotonicNowNs();
            sample.q_DT[0] = 1;
            height = std::max(0.0, height - 2e-6);
            sample.p_DT[1] = says_nonsense ? 1e6 : height;  // along W's z
            sample.buttons = kButtonRemove;
            sample.state = uint32_t(state.load());
            sample.stop_cause = uint32_t(cause.load());
            sample.flags = kDeviceFlagSimulated;
            if (SceneNotice scene; link_.readScene(scene)) sample.scene_revision = scene.revision;
            link_.writeSample(sample);
            WrenchCommand command;
            if (!link_.readCommand(command)) continue;
            reset_orders = command.reset_orders;
            force = Eigen::Vector3d(command.f_hand_D).norm();
            torque = Eigen::Vector3d(command.t_hand_D).norm();
        }
    }

    DeviceLink link_;
    std::jthread thread_;
};

class DeviceStateOfASession : public testing::Test {
  protected:
    DeviceStateOfASession() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        // The slab's top is at z = 2 mm, the burr's radius is 1 mm.
        test::writeFile(folder_ / "s.textproto",
                        "name: \"state\" effects { time_removal {} } volume { path: \"slab.nrrd\" }\n"
                        "device { p_WD_mm { x: 0 y: 0.1 z: 2.3 } q_WD { w: 0.70710678 x: 0.70710678 } }\n");
    }
    std::vector<std::string> server() const {
        return {"haptic_server", "--scene",  folder_ / "s.textproto", "--session", session(), "--domain",
                domain(),        "--report", folder_ / "report.json"};
    }
    static std::string session() { return std::to_string(testSession()); }
    static std::string domain() { return std::to_string(testDomain()); }

    bool isShown(SafetyState state) {
        return probe_.pollUntil([&] {
            const auto& status = probe_.subscriber.status();
            return status && status->device().state() == uint32_t(state);
        });
    }
    const topics::Status& status() { return *probe_.subscriber.status(); }

    test::TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(DeviceStateOfASession, IsShownActedOnLoggedAndReported) {
    Process server_process(server());
    ASSERT_TRUE(probe_.pollUntil([this] { return probe_.subscriber.status().has_value(); }));
    EXPECT_FALSE(status().has_device()) << "there was none yet";
    FakeDevice device;

    ASSERT_TRUE(isShown(SafetyState::kReady));
    EXPECT_EQ(status().device().name(), "test arm");
    EXPECT_TRUE(status().device().is_simulated());
    EXPECT_EQ(status().device().max_force_n(), 2);
    ASSERT_TRUE(waitFor([&] { return device.force > 0.2; })) << "contact goes on";
    EXPECT_EQ(status().removed_mm3(), 0);

    device.cause = StopCause::kSpeed;
    device.state = SafetyState::kProtectiveStop;
    ASSERT_TRUE(isShown(SafetyState::kProtectiveStop));
    EXPECT_EQ(status().device().stop_cause(), uint32_t(StopCause::kSpeed));
    ASSERT_TRUE(probe_.pollUntil([this] {
        const auto& tool = probe_.subscriber.toolState();
        return tool && tool->device_state() == uint32_t(SafetyState::kProtectiveStop);
    }));
    EXPECT_EQ(status().removed_mm3(), 0) << "the pedal does nothing but while the device is engaged";

    EXPECT_EQ(device.reset_orders, 0u);
    const auto reset = run({"render_client", "--command", "reset-device", "--role", "operator", "--session",
                            session(), "--domain", domain()});
    EXPECT_EQ(reset.exit_code, 0) << reset.out << reset.err;
    EXPECT_TRUE(waitFor([&] { return device.reset_orders == 1; }));

    device.cause = StopCause::kNone;
    device.state = SafetyState::kEngaged;
    EXPECT_TRUE(probe_.pollUntil([this] { return status().removed_mm3() > 0; }));
    EXPECT_LE(device.force, 2 * (1 + 1e-9));
    EXPECT_EQ(device.torque, 0);

    EXPECT_EQ(status().fault_text().find("implausible_device"), std::string::npos);
    device.says_nonsense = true;
    EXPECT_TRUE(probe_.pollUntil(
        [this] { return status().fault_text().find("implausible_device") != std::string::npos; }));

    server_process.signal(SIGTERM);
    const auto ended = server_process.wait();
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const std::string log = ended.out + ended.err;
    const std::string told = std::string("protective stop: too fast. ") + whatToDo(StopCause::kSpeed);
    EXPECT_NE(log.find(told), std::string::npos) << log;
    EXPECT_EQ(log.find(told), log.rfind(told)) << "it is told once";
    EXPECT_NE(log.find("the device is test arm: 2 N, no torque"), std::string::npos) << log;
    const auto report = nlohmann::json::parse(test::readFile(folder_ / "report.json"));
    ASSERT_EQ(report["device_changes"], 3) << report["device_states"];
    EXPECT_EQ(report["device_states"][1]["cause"], "too fast");
    EXPECT_TRUE(report["fault_ticks"].contains("implausible_device"));
}

}  // namespace
}  // namespace bonemill
