#include "device_daemon/ares/driver/udp_joint_device.h"

#include <algorithm>

#include "device_daemon/ares/driver/wire_status.h"

namespace bonemill {
namespace {

// A motor is as warm as a room at load 0, and at 1 as hot as a touched housing may make its windings.
constexpr double kColdMotor_dc = 200;  // 0.1 °C
constexpr double kHotMotor_dc = 800;

double loadOf(const int16_t (&temperature_dc)[6]) noexcept {
    const double hottest_dc = *std::max_element(temperature_dc, temperature_dc + 6);
    return std::clamp((hottest_dc - kColdMotor_dc) / (kHotMotor_dc - kColdMotor_dc), 0.0, 1.0);
}

}  // namespace

bool UdpJointDevice::readJoints(double, JointReading& reading) noexcept {
    const wire::JointState* state = device_.read();
    if (!state) return false;
    reading.q = Eigen::Map<const Vector6d>(state->q);
    reading.q_dot = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(state->qd).cast<double>();
    reading.forces = Eigen::Map<const Eigen::Matrix<float, 6, 1>>(state->force).cast<double>();
    reading.buttons = buttonsOf(state->inputs);
    reading.status = device_.status();
    reading.fault = device_.fault();
    reading.fault_code = state->first_fault;
    reading.load = loadOf(state->temperature_dc);
    reading.taken_ns = int64_t(state->controller_ns);
    return true;
}

void UdpJointDevice::applyForces(const JointOrder& order) noexcept {
    wire::JointCommand command{};
    if (order.is_wanted) {
        Eigen::Map<Eigen::Matrix<float, 6, 1>>(command.force) = order.forces.cast<float>();
    }
    device_.write(command, {order.is_wanted, order.is_engaged, order.reset});
}

const wire::Describe* UdpJointDevice::description() const noexcept {
    return descriptionCount() > 0 ? &device_.session().description() : nullptr;
}

}  // namespace bonemill
