#include "device_daemon/bridges/touch/touch_arm.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/bridges/bridge/axes.h"

namespace bonemill::bridge {
namespace {

constexpr UsbId kTouchUsb[] = {{"0301", "2988"}, {"2988", "0302"}};
constexpr uint64_t kConditionEvery = 100;  // ticks
constexpr int kLastTickMs = 200;
// A library that does not say what its arm can do gets what the weakest arm can.
constexpr double kCautiousForce = 2;     // N
constexpr double kStrongestArm = 40;     // N; whoever says more is not believed
constexpr double kCautiousReach = 0.08;  // m

uint32_t faultOf(unsigned error) noexcept {
    switch (error) {
        case kHdWarmMotors:
            return wire::kFaultOverTemperature;
        case kHdExceededVelocity:
            return wire::kFaultOverSpeed;
        case kHdExceededForce:
        case kHdExceededImpulse:
        case kHdForceError:
            return wire::kFaultAmplifier;
        default:  // it counts as one failed period
            return 0;
    }
}

}  // namespace

// The driver fails when it is loaded a second time, and its own parts look for symbols of this one.
HdLibrary::HdLibrary(const std::string& chosen, const Tell& tell)
    : library_({"libHD.so", "OpenHaptics and the Touch driver of 3D Systems", chosen, true, {}}) {
    tell("library: " + library_.path());
#define REQUIRE(function) library_.require(function, #function)
    REQUIRE(hdInitDevice);
    REQUIRE(hdDisableDevice);
    REQUIRE(hdMakeCurrentDevice);
    REQUIRE(hdBeginFrame);
    REQUIRE(hdEndFrame);
    REQUIRE(hdEnable);
    REQUIRE(hdDisable);
    REQUIRE(hdGetIntegerv);
    REQUIRE(hdGetDoublev);
    REQUIRE(hdSetDoublev);
    REQUIRE(hdGetString);
    REQUIRE(hdGetError);
    REQUIRE(hdGetErrorString);
    REQUIRE(hdCheckCalibration);
    REQUIRE(hdStartScheduler);
    REQUIRE(hdStopScheduler);
    REQUIRE(hdScheduleAsynchronous);
    REQUIRE(hdUnschedule);
#undef REQUIRE
    library_.allow(hdUpdateCalibration, "hdUpdateCalibration");
    library_.checkFunctions(tell);
}

unsigned HdLibrary::takeErrors() noexcept {
    constexpr int kDeepest = 64;  // a library that never runs out of errors must not hold its own thread
    unsigned oldest = 0;
    for (int i = 0; i < kDeepest; ++i) {
        const HdErrorInfo error = hdGetError();
        if (error.code == 0) break;
        oldest = error.code;
    }
    return oldest;
}

std::string HdLibrary::textOf(unsigned error) const {
    char number[16];
    std::snprintf(number, sizeof(number), "0x%04x", error);
    const char* text = hdGetErrorString(error);
    return std::string("error ") + number + ", " + (text ? text : "no text");
}

ArmDescription TouchArm::open(const Tell& tell) {
    tell_ = tell;
    hd_.emplace(options_.library, tell);
    openDevice();
    return describe();
}

void TouchArm::openDevice() {
    // Some installations know their only arm by no name, and others by one of these alone.
    std::vector<const char*> names{nullptr, "Default Device", "Default PHANToM"};
    if (!options_.device.empty()) names = {options_.device.c_str()};
    unsigned error = 0;
    for (const char* name : names) {
        device_ = hd_->hdInitDevice(name);
        error = hd_->takeErrors();
        if (device_ != kHdNoDevice && error == 0) return;
    }
    device_ = kHdNoDevice;
    throw UserError(
        whyNoDevice(findUsb(kTouchUsb), "Touch") + " The library says " + hd_->textOf(error) +
        ". Name the arm in Touch_Setup, and with --device, if it has another name; an arm on Ethernet or "
        "FireWire is not on USB.");
}

ArmDescription TouchArm::describe() {
    hd_->hdMakeCurrentDevice(device_);
    const auto text = [&](HdEnum parameter) {
        const char* value = hd_->hdGetString(parameter);
        return std::string(value ? value : "");
    };
    double max_force = 0;
    double workspace_mm[6] = {};
    int input_dof = 0;
    hd_->hdGetDoublev(kHdNominalMaxForce, &max_force);
    hd_->hdGetDoublev(kHdUsableWorkspace, workspace_mm);
    hd_->hdGetIntegerv(kHdInputDof, &input_dof);
    hd_->takeErrors();
    tell_("driver: " + text(kHdDriverVersion));
    const Eigen::Vector3d low = Eigen::Map<const Eigen::Vector3d>(workspace_mm) * kMillimetre;
    const Eigen::Vector3d high = Eigen::Map<const Eigen::Vector3d>(workspace_mm + 3) * kMillimetre;
    const double reach = (high - low).minCoeff() / 2;
    const bool has_workspace = low.allFinite() && high.allFinite() && reach > 0 && reach < 1;
    if (has_workspace) middle_V_ = (low + high) / 2;
    has_orientation_ = input_dof >= 6;

    ArmDescription description;
    description.name = text(kHdModelType);
    description.serial = std::strtoull(text(kHdSerialNumber).c_str(), nullptr, 10);
    description.kind = DeviceKind::kTouch;
    description.has_orientation = has_orientation_;
    description.max_force = max_force > 0 && max_force < kStrongestArm ? max_force : kCautiousForce;
    description.workspace_radius = has_workspace ? reach : kCautiousReach;
    return description;
}

void TouchArm::start(ArmPeriod& period) {
    period_ = &period;
    hd_->hdMakeCurrentDevice(device_);
    hd_->hdDisable(kHdForceOutput);  // the scheduler switches on what is enabled
    schedule_ = hd_->hdScheduleAsynchronous(onTick, this, kHdMaxPriority);
    is_scheduled_ = true;
    hd_->hdStartScheduler();
    if (const unsigned error = hd_->takeErrors())
        throw UserError("device: the library does not start its scheduler: " + hd_->textOf(error));
}

void TouchArm::stop() noexcept {
    if (device_ == kHdNoDevice) return;
    shall_end_ = true;
    for (int i = 0; is_scheduled_ && !has_ended_ && i < kLastTickMs; ++i) usleep(1000);
    if (is_scheduled_) {
        hd_->hdStopScheduler();
        hd_->hdUnschedule(schedule_);
        is_scheduled_ = false;
    }
    hd_->hdDisableDevice(device_);
    device_ = kHdNoDevice;
}

unsigned TouchArm::onTick(void* arm) noexcept {
    static_cast<TouchArm*>(arm)->tick();
    return kHdCallbackContinue;
}

void TouchArm::tick() noexcept {
    hd_->hdBeginFrame(device_);
    const ArmReading reading = read();
    if (shall_end_) {
        write({});
        has_ended_ = true;
    } else {
        write(period_.load()->step(reading, monotonicNowNs()));
    }
    hd_->hdEndFrame(device_);
    takeErrors();
}

ArmReading TouchArm::read() noexcept {
    if (ticks_++ % kConditionEvery == 0) readCondition();
    ArmReading reading = last_;
    int buttons = 0;
    hd_->hdGetIntegerv(kHdCurrentButtons, &buttons);
    reading.buttons = (buttons & 1 ? kButtonRemove : 0u) | (buttons & 2 ? kButtonAdd : 0u);
    readPose(reading);
    reading.is_powered = true;
    reading.has_failed = error_ != 0;
    reading.faults = faultOf(error_);
    reading.fault_code = error_;
    return reading;
}

void TouchArm::readPose(ArmReading& reading) noexcept {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    Eigen::Matrix4d transform = Eigen::Matrix4d::Constant(kUnknown);
    hd_->hdGetDoublev(kHdCurrentTransform, transform.data());
    const auto rotation = has_orientation_ ? repairedRotation(transform.topLeftCorner<3, 3>())
                                           : std::optional(Eigen::Quaterniond::Identity());
    const Eigen::Vector3d p_V = transform.topRightCorner<3, 1>() * kMillimetre - middle_V_;
    reading.is_valid = rotation && p_V.allFinite();
    if (reading.is_valid) reading.X_DT = poseInD(kTouchAxes, p_V, *rotation);
}

// An arm that is not calibrated reports a position that stands still.
void TouchArm::readCondition() noexcept {
    const HdEnum calibration = hd_->hdCheckCalibration();
    last_.is_homed = calibration == kHdCalibrationOk;
    int style = 0;
    if (calibration == kHdNeedsUpdate && hd_->hdUpdateCalibration) {
        hd_->hdGetIntegerv(kHdCalibrationStyle, &style);
        hd_->hdUpdateCalibration(HdEnum(style));
    }
    double temperatures[6] = {};
    hd_->hdGetDoublev(kHdMotorTemperature, temperatures);
    const double hottest = *std::max_element(temperatures, temperatures + 6);
    last_.load = std::isfinite(hottest) ? hottest : 0;
}

void TouchArm::write(const ArmOrder& order) noexcept {
    if (order.is_driving != is_driving_) {
        if (order.is_driving)
            hd_->hdEnable(kHdForceOutput);
        else
            hd_->hdDisable(kHdForceOutput);
        is_driving_ = order.is_driving;
    }
    const Eigen::Vector3d force = wrenchInV(kTouchAxes, order.wrench_D).force;
    hd_->hdSetDoublev(kHdCurrentForce, force.data());
}

void TouchArm::takeErrors() noexcept {
    error_ = hd_->takeErrors();
}

}  // namespace bonemill::bridge
