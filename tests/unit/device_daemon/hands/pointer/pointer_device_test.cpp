// Viewers on a real topic hold the device, are silent, quarrel and send garbage; the loop's side runs in time
// of its own.
#include "device_daemon/hands/pointer/pointer_device.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>

#include <cmath>

#include "common/rt/clock.h"
#include "device_daemon/control/device_loop/device_loop.h"
#include "tests/support/hand_pointer.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr double kPeriod = 1e-3;  // s
const Pose kX_WD{{0.05, 0.02, -0.01}, expRotation({0, 0, M_PI / 2})};
const Pose kStart{{0, 0, 0.01}, Eigen::Quaterniond::Identity()};

Pose at(double x, double y, double z) {
    return {{x, y, z}, Eigen::Quaterniond::Identity()};
}

class Pointer : public testing::Test {
  protected:
    Pointer()
        : device_({.domain = testDomain(), .session = testSession(), .X_WD = kX_WD, .X_DT_start = kStart}) {}

    void connect(test::PointingViewer& viewer) {
        ASSERT_TRUE(test::waitFor([&] { return viewer.readers() > 0; }));
    }
    void run(double seconds) {
        for (int i = 0; i < std::lround(seconds / kPeriod); ++i) {
            ASSERT_TRUE(device_.read(kPeriod, reading_));
            device_.write({.wrench_hand_D = wrench_, .is_wanted = true, .is_engaged = true});
        }
    }
    bool isHeld() const { return reading_.status & kStatusEnabled; }
    // Sends the wish until the loop has it, and no other is under way any more; no time passes for the loop.
    void wantUntilHeld(test::PointingViewer& viewer, const Pose& X_WT, uint32_t buttons) {
        ASSERT_TRUE(test::waitFor([&] {
            viewer.want(X_WT, buttons);
            for (int i = 0; i < 20; ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                device_.read(0, reading_);
            }
            return isHeld() && reading_.buttons == buttons;
        }));
    }

    PointerDevice device_;
    DeviceReading reading_;
    Wrench wrench_;
};

// Catches the log. It is made before the device, whose thread must not see the logger change.
class CaughtLog {
  protected:
    CaughtLog() { spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink_)); }
    ~CaughtLog() { spdlog::set_default_logger(logger_before_); }

    const std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> sink_ =
        std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(10'000);

  private:
    const std::shared_ptr<spdlog::logger> logger_before_ = spdlog::default_logger();
};

class LoggedPointer : public CaughtLog, public Pointer {};

TEST_F(Pointer, SaysWhatItIs) {
    const DeviceCapabilities capabilities = device_.capabilities();
    EXPECT_TRUE(isPlausible(capabilities));
    EXPECT_EQ(capabilities.kind, uint32_t(DeviceKind::kPointer));
    EXPECT_GT(capabilities.max_force, VirtualHand{}.max_force) << "or the hand would win at the limit";
    EXPECT_FALSE(device_.hasClock());
}

TEST_F(Pointer, RestsAtItsStartUntilAViewerHoldsIt) {
    run(0.5);
    EXPECT_FALSE(isHeld());
    EXPECT_LT((reading_.X_DT.position - kStart.position).norm(), 1e-12);
    EXPECT_EQ(reading_.status & kStatusCalibrated, uint32_t{kStatusCalibrated});
}

TEST_F(Pointer, TheHandleGoesWhereTheViewerWantsItInW) {
    test::PointingViewer viewer(1);
    connect(viewer);
    const Pose wanted{{0.06, 0.03, 0.02}, expRotation({0.1, 0.2, 0.3})};
    wantUntilHeld(viewer, wanted, kButtonRemove);
    run(0.15);
    EXPECT_EQ(reading_.buttons, uint32_t{kButtonRemove});
    run(0.8);
    const Pose X_WT = kX_WD * reading_.X_DT;
    EXPECT_LT((X_WT.position - wanted.position).norm(), 1e-5);
    EXPECT_LT(X_WT.rotation.angularDistance(wanted.rotation), 1e-4);
}

TEST_F(Pointer, TheWrenchPushesTheHandle) {
    wrench_.force = {0, 0, 3};
    run(1);
    EXPECT_NEAR(reading_.X_DT.position.z() - kStart.position.z(), 3 / VirtualHand{}.stiffness, 1e-5);
    EXPECT_EQ(reading_.applied_D.force.z(), 3);
    device_.write({.wrench_hand_D = {{0, 0, 2}, {0, 0, 0}}, .is_wanted = true, .is_engaged = false});
    device_.read(kPeriod, reading_);
    EXPECT_EQ(reading_.applied_D.force.z(), 2)
        << "it fades after a pause: a mouse has no motors that could fail";
}

TEST_F(Pointer, AWishWithANewPlacementIsThereAtOnceForEachViewer) {
    test::PointingViewer first(1), second(2);
    connect(first);
    connect(second);
    const auto whereIs = [&] { return Eigen::Vector3d((kX_WD * reading_.X_DT).position); };
    const auto wantPlaced = [&](test::PointingViewer& viewer, const Pose& X_WT, uint32_t number) {
        const uint32_t before = reading_.placements;
        return test::waitFor([&] {
            viewer.want(X_WT, 0, number);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            device_.read(kPeriod, reading_);
            return reading_.placements != before;
        });
    };
    wrench_.force = {0, 0, 1};
    run(0.2);
    EXPECT_EQ(reading_.placements, 0u);
    ASSERT_TRUE(wantPlaced(first, at(0.10, 0.02, 0), 1));
    EXPECT_LT((whereIs() - Eigen::Vector3d(0.10, 0.02, 0)).norm(), 1e-4);
    EXPECT_LT(reading_.v_DT.norm(), 0.01);
    first.want(at(0.05, 0.02, 0), 0, 1);
    run(0.02);
    EXPECT_EQ(reading_.placements, 1u) << "it goes there";
    ASSERT_TRUE(wantPlaced(first, at(0.00, 0.02, 0), 2));
    EXPECT_LT((whereIs() - Eigen::Vector3d(0.00, 0.02, 0)).norm(), 1e-4);
    first.letGo();
    ASSERT_TRUE(wantPlaced(second, at(0.10, 0.06, 0), 2)) << "numbers are each viewer's own";
    EXPECT_EQ(reading_.placements, 3u);
}

// The tool was held by the bone with all that the hand has when the server fell silent.
TEST_F(Pointer, AForceThatFadesIsNoFaultOfMotors) {
    DeviceLoop loop(device_, {.wrench = {}, .motion = {}, .states = {.ramp_time = 0.3}});
    DeviceSample sample;
    WrenchCommand command{};
    int64_t now_ns = kNsPerSecond;
    for (int i = 0; i < 3000; ++i) {
        now_ns += kNsPerMillisecond;
        ASSERT_TRUE(loop.read(now_ns, kPeriod, sample));
        if (i < 2000) command.stamp_ns = now_ns;
        command.f_hand_D[2] = i < 1000 ? 0 : 8;
        loop.write(&command, now_ns);
        if (i == 1990) {
            EXPECT_EQ(loop.safety().state(), SafetyState::kEngaged);
            EXPECT_NEAR(loop.given().force.z(), 8, 1e-6);
        }
        ASSERT_NE(loop.safety().state(), SafetyState::kFault)
            << nameOf(loop.safety().cause()) << ", period " << i;
    }
    EXPECT_EQ(loop.given().force.norm(), 0);
}

// A viewer does not know of another scene at once, and what it wants until then is of the old one.
TEST_F(Pointer, WishesOfAnotherRunOfTheServerDoNotCount) {
    test::PointingViewer viewer(1);  // it shows run 1
    connect(viewer);
    device_.followRun(2);
    for (int i = 0; i < 20; ++i) {
        viewer.want(at(0.10, 0.02, 0), kButtonRemove, 5);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        run(0.01);
    }
    EXPECT_FALSE(isHeld());
    EXPECT_EQ(reading_.placements, 0u);
    EXPECT_EQ(device_.malformedWishes(), 0u);
    device_.followRun(1);
    wantUntilHeld(viewer, at(0.10, 0.02, 0), kButtonRemove);
}

TEST_F(Pointer, AnAttemptBeginsWhereTheSceneDoes) {
    test::PointingViewer viewer(1);
    connect(viewer);
    wantUntilHeld(viewer, at(0.10, 0.02, 0), 0);
    run(0.5);
    ASSERT_GT((reading_.X_DT.position - kStart.position).norm(), 0.03);
    device_.beginAttempt();
    run(kPeriod);
    EXPECT_LT((reading_.X_DT.position - kStart.position).norm(), 1e-4);
    EXPECT_EQ(reading_.placements, 1u);
}

TEST_F(Pointer, SilenceReleasesTheButtonsAndThenTheTool) {
    test::PointingViewer viewer(1);
    connect(viewer);
    wantUntilHeld(viewer, at(0.10, 0.02, 0), kButtonRemove);
    run(0.19);
    EXPECT_EQ(reading_.buttons, uint32_t{kButtonRemove});
    run(0.02);
    EXPECT_EQ(reading_.buttons, 0u);
    EXPECT_TRUE(isHeld());
    run(0.8);
    EXPECT_FALSE(isHeld());
    const Eigen::Vector3d where = reading_.X_DT.position;
    run(1);
    EXPECT_LT((reading_.X_DT.position - where).norm(), 1e-3);
    wantUntilHeld(viewer, at(0.10, 0.02, 0), kButtonAdd);  // it is back
}

TEST_F(Pointer, LettingGoReleasesAtOnce) {
    test::PointingViewer viewer(1);
    connect(viewer);
    wantUntilHeld(viewer, at(0.5, 0, 0), kButtonRemove);
    ASSERT_TRUE(test::waitFor([&] {
        viewer.letGo();
        device_.read(0, reading_);
        return !isHeld();
    }));
    EXPECT_EQ(reading_.buttons, 0u);
}

TEST_F(Pointer, ASecondViewerWaitsForItsTurn) {
    test::PointingViewer first(1), second(2);
    connect(first);
    connect(second);
    wantUntilHeld(first, at(0.06, 0.02, 0), kButtonRemove);
    for (int i = 0; i < 20; ++i) {
        second.want(at(0, 0, 0), kButtonAdd);
        first.want(at(0.06, 0.02, 0), kButtonRemove);
        run(0.01);
        EXPECT_NE(reading_.buttons, uint32_t{kButtonAdd});
    }
    ASSERT_TRUE(test::waitFor([&] {
        first.letGo();
        second.want(at(0, 0, 0), kButtonAdd);
        device_.read(0, reading_);
        return reading_.buttons == kButtonAdd;
    }));
}

TEST_F(LoggedPointer, AViewerThatHoldsAndLetsGoWithoutEndDoesNotFillTheLog) {
    test::PointingViewer viewer(1);
    connect(viewer);
    const int64_t start_ns = monotonicNowNs();
    for (int i = 0; i < 300; ++i) {
        viewer.want(at(0.06, 0.02, 0));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        viewer.letGo();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const auto seconds = size_t((monotonicNowNs() - start_ns) / kNsPerSecond);
    const auto lines = sink_->last_formatted();
    ASSERT_FALSE(lines.empty());
    EXPECT_NE(lines[0].find("viewer 1 holds the tool"), std::string::npos) << lines[0];
    EXPECT_LE(lines.size(), 110 + seconds);
}

TEST_F(Pointer, GarbageIsCountedAndChangesNothing) {
    test::PointingViewer viewer(1);
    connect(viewer);
    ASSERT_TRUE(test::waitFor([&] {
        viewer.send("garbage");
        return device_.malformedWishes() > 2;
    }));
    device_.read(kPeriod, reading_);
    EXPECT_FALSE(isHeld());
    wantUntilHeld(viewer, at(0.06, 0.02, 0), 0);
}

}  // namespace
}  // namespace bonemill
