#include "tests/stability/drive.h"

#include <cmath>

#include "common/geometry/bounded_vector.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

double spread(const std::vector<Eigen::Vector3d>& values, size_t first, size_t end) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (size_t n = first; n < end; ++n) mean += values[n] / double(end - first);
    double sum = 0;
    for (size_t n = first; n < end; ++n) sum += (values[n] - mean).squaredNorm();
    return std::sqrt(sum / double(end - first));
}

double spread(const std::vector<Eigen::Vector3d>& values) {
    return spread(values, 0, values.size());
}

// Takes means over `window` values in a row.
std::vector<Eigen::Vector3d> averaged(const std::vector<Eigen::Vector3d>& values, size_t window) {
    std::vector<Eigen::Vector3d> means;
    for (size_t n = 0; n + window <= values.size(); ++n) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (size_t i = 0; i < window; ++i) sum += values[n + i];
        means.push_back(sum / double(window));
    }
    return means;
}

constexpr double kPlentyOfForce = 50, kPlentyOfTorque = 1;  // N, N·m: more than any case presses with

}  // namespace

Stepper::Stepper(Scene& scene, const ToolSwitch* tools, BoneHistory* history)
    : held_buttons_(scene.held_buttons),
      own_tool_({scene.spoTool()}),
      accuracy_(scene.config.accuracy),
      tick_(scene.config, {scene.bone, history}, {tools ? *tools : own_tool_, accuracy_}) {
    plugIn(scene.device);
}

const TickRecord& Stepper::step(const Pose& X_WT_device, uint32_t buttons) {
    input_.X_WT_device = X_WT_device;
    input_.buttons = buttons | held_buttons_;
    record_ = *tick_.tick(*this);
    faults_ |= record_.faults;
    plugIn(nullptr);
    return record_;
}

bool Stepper::read(DeviceInput& input) noexcept {
    input = input_;
    return true;
}

int64_t Stepper::write(const Wrench& wrench_hand_W) noexcept {
    wrench_ = wrench_hand_W;
    return 0;
}

DeviceCapabilities declaredLittle(const LoopConfig& config) {
    DeviceCapabilities says{};
    says.abilities =
        kAbilityForce | kAbilityOrientation | (config.has_torque ? uint32_t(kAbilityTorque) : 0u);
    says.max_force = config.most_force > 0 ? config.most_force : kPlentyOfForce;
    says.max_torque = config.has_torque ? kPlentyOfTorque : 0;
    return says;
}

DeviceCapabilities declared(const LoopConfig& config, double dt) {
    const DevicePlant& device = config.device;
    DeviceCapabilities says = declaredLittle(config);
    says.handle = {.mass = device.mass,
                   .damping = device.damping,
                   .inertia = device.inertia,
                   .angular_damping = device.angular_damping,
                   .amplifier_time = 1 / (2 * M_PI * device.amplifier_hz),
                   .delay = (config.delay_ticks + config.late_ticks + config.jitter_ticks / 2) * dt,
                   .encoder_step = device.encoder_step,
                   .encoder_angle = device.encoder_angle};
    return says;
}

DeviceCapabilities declaredWrongly(const LoopConfig& config, double dt, double share, uint32_t seed) {
    DeviceCapabilities says = declared(config, dt);
    std::minstd_rand random(seed);
    HandleDynamics& handle = says.handle;
    for (double* figure :
         {&handle.mass, &handle.damping, &handle.inertia, &handle.angular_damping, &handle.amplifier_time,
          &handle.delay, &handle.encoder_step, &handle.encoder_angle})
        *figure *= random() % 2 == 0 ? 1 + share : 1 - share;
    return says;
}

ClosedLoop::ClosedLoop(const LoopConfig& config, Scene& scene, const Pose& start, const ToolSwitch* tools,
                       BoneHistory* history)
    : plant(config.device, config.hand, start),
      stepper(scene, tools, history),
      dt(scene.config.dt),
      averaged_ticks(scene.averaged_ticks),
      config_(config),
      start_(start),
      workspace_scale_(scene.config.hand_space.wayAtTool(1.0)),
      on_the_way_(size_t(config.delay_ticks)) {}

void ClosedLoop::declare(const DeviceCapabilities& says) {
    declared_ = says;
    stepper.plugIn(&declared_);
}

Pose ClosedLoop::toolPose() const noexcept {
    Pose pose = plant.measured();
    pose.position += (workspace_scale_ - 1) * (pose.position - start_.position);
    return pose;
}

void ClosedLoop::actuate(double time) {
    Wrench given = held_;
    if (config_.most_force > 0) limitLength(given.force, config_.most_force);
    if (!config_.has_torque) given.torque.setZero();
    plant.advance(time, given);
}

void ClosedLoop::step(uint32_t buttons) {
    if (config_.lost_share > 0 && random() < config_.lost_share) return dropTick();
    stepper.step(toolPose(), buttons);
    on_the_way_.push_back(stepper.wrenchOnHand());
    const double jitter = config_.jitter_ticks > 0 ? config_.jitter_ticks * random() : 0;
    const double late = std::min(1.0, config_.late_ticks + jitter);
    if (late > 0) actuate(late * dt);
    held_ = on_the_way_.front();
    on_the_way_.pop_front();
    actuate((1 - late) * dt);
}

void ClosedLoop::dropTick() {
    actuate(dt);
}

void ClosedLoop::run(double seconds) {
    const long ticks = std::lround(seconds / dt);
    for (long n = 0; n < ticks; ++n) step();
}

Residual residual(ClosedLoop& loop, double seconds) {
    std::vector<Eigen::Vector3d> force, torque, position;
    Residual result;
    const long ticks = std::lround(seconds / loop.dt);
    for (long n = 0; n < ticks; ++n) {
        loop.step();
        result.is_finite &= loop.stepper.isFinite() && loop.plant.pose().isFinite();
        force.push_back(loop.stepper.wrenchOnHand().force);
        torque.push_back(loop.stepper.wrenchOnHand().torque);
        position.push_back(loop.plant.pose().position);
    }
    const size_t half = force.size() / 2;
    result.is_touching = loop.stepper.record().contacts > 0;
    result.rms = spread(averaged(force, loop.averaged_ticks));
    result.torque_rms = spread(torque);
    result.position_rms = spread(position);
    result.growth = spread(position, half, position.size()) / std::max(spread(position, 0, half), 1e-12);
    return result;
}

double forceBuzz(ClosedLoop& loop, double settle, double watch) {
    loop.run(settle);
    const Residual r = residual(loop, watch);
    if (!r.is_finite) return kNan;
    return r.is_touching ? r.rms : kLost;
}

}  // namespace bonemill::test
