#include "device_daemon/bridges/force_dimension/force_dimension_arm.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/bridges/bridge/axes.h"
#include "device_daemon/bridges/bridge/vendor_device.h"

namespace bonemill::bridge {
namespace {

constexpr SystemType kTypes[] = {
    {63, "delta.3", 20, 0, 5000, 0.150},         {33, "omega.3", 12, 0, 5000, 0.075},
    {34, "omega.6", 12, 0, 5000, 0.075},         {36, "omega.6 left", 12, 0, 5000, 0.075},
    {35, "omega.7", 12, 0, 5000, 0.075},         {37, "omega.7 left", 12, 0, 5000, 0.075},
    {206, "sigma.3", 12, 0, 4000, 0.075},        {104, "sigma.7", 12, 0.2, 4000, 0.075},
    {105, "sigma.7 left", 12, 0.2, 4000, 0.075}, {203, "lambda.3", 12, 0, 8000, 0.112},
    {131, "lambda.6", 12, 0, 8000, 0.112},       {132, "lambda.6 left", 12, 0, 8000, 0.112},
    {108, "lambda.7", 12, 0.2, 8000, 0.112},     {109, "lambda.7 left", 12, 0.2, 8000, 0.112},
    {60, "Falcon", 8, 0, 3000, 0.040},
};

constexpr UsbId kForceDimensionUsb[] = {{"1451", ""}, {"0403", "cb48"}};
constexpr uint64_t kStatusEvery = 20;  // periods
constexpr int kPatienceMs = 500;
constexpr unsigned char kOn = 1, kOff = 0;

char indexOf(const std::string& device, int count) {
    int index = 0;
    const auto end = device.data() + device.size();
    if (!device.empty() && std::from_chars(device.data(), end, index).ptr != end)
        throw UserError("--device " + device + ": give the arm's number, 0 for the first");
    if (index < 0 || index >= count)
        throw UserError("--device " + device + ": the SDK sees " + std::to_string(count) +
                        " arms, numbered from 0");
    return static_cast<char>(index);
}

uint32_t buttonsOf(unsigned mask) noexcept {
    return (mask & 1u ? kButtonRemove : 0u) | (mask & 2u ? kButtonAdd : 0u);
}

uint32_t faultOf(int force_off_cause) noexcept {
    return force_off_cause == kOffByVelocity ? wire::kFaultOverSpeed : wire::kFaultAmplifier;
}

}  // namespace

SystemType systemTypeOf(int type) noexcept {
    const auto found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                    [type](const SystemType& known) { return known.type == type; });
    if (found != std::end(kTypes)) return *found;
    return {type, "Force Dimension arm of unknown type", 8, 0, 3000, 0.040};
}

ArmDescription ForceDimensionArm::open(const Tell& tell) {
    tell_ = tell;
    sdk_.emplace(options_.library, tell);
    openArm();
    return describe();
}

void ForceDimensionArm::openArm() {
    const int count = sdk_->dhdGetDeviceCount();
    if (count <= 0)
        throw UserError(whyNoDevice(findUsb(kForceDimensionUsb), "Force Dimension arm or Falcon"));
    id_ = indexOf(options_.device, count);
    const int opened = sdk_->openArm(id_);
    if (opened < 0)
        throw UserError("device: the SDK cannot open arm " + std::to_string(int(id_)) + ": " +
                        sdk_->lastError());
    id_ = static_cast<char>(opened);
    is_open_ = true;
    type_ = systemTypeOf(sdk_->dhdGetSystemType(id_));
    has_wrist_ = sdk_->dhdHasWrist && sdk_->dhdGetPositionAndOrientationFrame && sdk_->dhdHasWrist(id_);
    if (sdk_->dhdHasGripper && sdk_->dhdEmulateButton && sdk_->dhdHasGripper(id_))
        check(sdk_->dhdEmulateButton(kOn, id_));
    readStatus();
    if (!last_.is_homed)
        tell_(
            "the arm is not calibrated: put it in its rest position or run the SDK's calibration; until then "
            "it "
            "gives no force");
}

ArmDescription ForceDimensionArm::describe() const {
    ArmDescription description;
    const char* name = sdk_->dhdGetSystemName ? sdk_->dhdGetSystemName(id_) : nullptr;
    description.name = name ? name : type_.name;
    unsigned short serial = 0;
    if (sdk_->dhdGetSerialNumber && isDhdSuccess(sdk_->dhdGetSerialNumber(&serial, id_)))
        description.serial = serial;
    description.kind = DeviceKind::kForceDimension;
    description.has_orientation = has_wrist_;
    // A limit that is set in the SDK is positive; none is negative.
    const double own_force = sdk_->dhdGetMaxForce ? sdk_->dhdGetMaxForce(id_) : -1;
    const double own_torque = sdk_->dhdGetMaxTorque ? sdk_->dhdGetMaxTorque(id_) : -1;
    description.max_force = own_force > 0 ? std::min(own_force, type_.max_force) : type_.max_force;
    const bool has_motors = !sdk_->dhdHasActiveWrist || sdk_->dhdHasActiveWrist(id_);
    description.max_torque = !has_motors      ? 0
                             : own_torque > 0 ? std::min(own_torque, type_.max_torque)
                                              : type_.max_torque;
    description.max_stiffness = type_.max_stiffness;
    description.workspace_radius = type_.workspace_radius;
    return description;
}

void ForceDimensionArm::start(ArmPeriod& period) {
    thread_ = startArmLoop(options_, tell_, [this, &period] { run(period); });
    has_thread_ = true;
}

void ForceDimensionArm::stop() noexcept {
    shall_end_ = true;
    if (has_thread_) {
        for (int i = 0; i < kPatienceMs && !has_ended_; ++i) usleep(1000);
        if (!has_ended_)
            sdk_->dhdStop(id_);  // the loop hangs in a call; another thread may still get through
        thread_.join();
    }
    has_thread_ = false;
    release();
}

void ForceDimensionArm::run(ArmPeriod& period) noexcept {
    PeriodicTimer timer(kPeriodNs, monotonicNowNs());
    while (!shall_end_) {
        timer.waitNext();
        const ArmReading reading = read();
        has_failed_ = false;
        write(period.step(reading, monotonicNowNs()));
    }
    has_ended_ = true;
}

ArmReading ForceDimensionArm::read() noexcept {
    if (periods_++ % kStatusEvery == 0) readStatus();
    ArmReading reading = last_;
    reading.is_valid = readPose(reading);
    if (sdk_->dhdGetButtonMask) reading.buttons = buttonsOf(sdk_->dhdGetButtonMask(id_));
    reading.has_failed = has_failed_;
    if (has_failed_) reading.fault_code = last_error_;
    return reading;
}

bool ForceDimensionArm::readPose(ArmReading& reading) noexcept {
    double x = 0, y = 0, z = 0;
    double frame[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int result = has_wrist_ ? sdk_->dhdGetPositionAndOrientationFrame(&x, &y, &z, frame, id_)
                                  : sdk_->dhdGetPosition(&x, &y, &z, id_);
    check(result);
    const Eigen::Matrix3d rotation = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame[0]);
    const std::optional<Eigen::Quaterniond> repaired = repairedRotation(rotation);
    if (!isDhdSuccess(result) || !repaired) return false;
    reading.X_DT = poseInD(kForceDimensionAxes, {x, y, z}, *repaired);
    return reading.X_DT.isFinite();
}

void ForceDimensionArm::readStatus() noexcept {
    int status[kStatusLength] = {};
    const int result = sdk_->dhdGetStatus(status, id_);
    check(result);
    if (!isDhdSuccess(result)) return;
    last_.is_powered = status[kDhdPower] && status[kDhdConnected];
    last_.is_homed = !status[kDhdReset] && (!sdk_->drdIsInitialized || sdk_->drdIsInitialized(id_));
    const bool is_off = is_driving_ && !status[kDhdForce];
    const int cause = is_off ? status[kDhdForceOffCause] : 0;
    last_.is_enabled = cause != kOffByButton && cause != kOffByDeadMan;
    last_.fault_code = uint32_t(cause);
    last_.faults = is_off && last_.is_enabled ? faultOf(cause) : 0;
}

void ForceDimensionArm::write(const ArmOrder& order) noexcept {
    if (order.is_driving != is_driving_) {
        check(sdk_->dhdEnableForce(order.is_driving ? kOn : kOff, id_));
        is_driving_ = order.is_driving;
        periods_ = 1;  // the arm has time to follow before its status is read
    }
    // The SDK adds what balances the arm's own weight to every force: zero has to be sent, too.
    const Wrench wrench = wrenchInV(kForceDimensionAxes, order.wrench_D);
    check(sdk_->dhdSetForceAndTorqueAndGripperForce(wrench.force.x(), wrench.force.y(), wrench.force.z(),
                                                    wrench.torque.x(), wrench.torque.y(), wrench.torque.z(),
                                                    0, id_));
}

void ForceDimensionArm::release() noexcept {
    if (!is_open_) return;
    is_open_ = false;
    sdk_->dhdSetForceAndTorqueAndGripperForce(0, 0, 0, 0, 0, 0, 0, id_);
    sdk_->dhdEnableForce(kOff, id_);
    sdk_->dhdStop(id_);
    sdk_->closeArm(id_);
}

void ForceDimensionArm::check(int result) noexcept {
    if (isDhdSuccess(result)) return;
    has_failed_ = true;
    last_error_ = uint32_t(std::max(0, sdk_->dhdErrorGetLast()));
}

}  // namespace bonemill::bridge
