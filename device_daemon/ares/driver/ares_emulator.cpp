#include "device_daemon/ares/driver/ares_emulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bonemill {
namespace {

// Physiological tremor has 8 to 12 Hz. The frequencies are incommensurable, so that the axes never move in
// step for long.
constexpr double kTremorFrequencies_hz[3][3] = {{8.3, 9.7, 11.9}, {8.9, 10.3, 11.3}, {8.1, 9.1, 10.9}};
constexpr double kTremorPhases_rad[3][3] = {{0.3, 1.9, 4.1}, {2.7, 5.3, 0.9}, {4.7, 3.1, 1.3}};

constexpr double kSubstepRate_hz = 25000;
constexpr double kRetreatTime = 0.7;     // s
constexpr double kRoundingSlack = 1e-6;  // so that 1 ms makes 25 substeps, not 26

constexpr double kGravity = 9.81;  // m/s²
// A motor must give more than this to push its slider through the play.
constexpr double kSliderFriction = 0.05;  // N
// Of motors with shorted windings, felt at the handle.
constexpr double kBrakeDamping = 20;           // N·s/m
constexpr double kBrakeAngularDamping = 0.05;  // N·m·s/rad

}  // namespace

OperatorPath::OperatorPath(std::vector<Waypoint> waypoints, double tremor)
    : waypoints_(std::move(waypoints)), tremor_(tremor) {
    for (size_t i = 0; i + 1 < waypoints_.size(); ++i) {
        turns_.push_back(
            logRotation(waypoints_[i + 1].X_DT.rotation * waypoints_[i].X_DT.rotation.conjugate()));
    }
}

HandTarget OperatorPath::at(double t) const noexcept {
    HandTarget target = withoutTremor(t);
    if (tremor_ > 0) addTremor(t, target);
    return target;
}

HandTarget OperatorPath::withoutTremor(double t) const noexcept {
    HandTarget target;
    if (waypoints_.empty()) return target;
    const auto after = std::upper_bound(waypoints_.begin(), waypoints_.end(), t,
                                        [](double time, const Waypoint& w) { return time < w.time; });
    target.waypoint = static_cast<int>(after - waypoints_.begin()) - 1;
    if (target.waypoint < 0) {
        target.X_DT = waypoints_.front().X_DT;
        return target;
    }
    const Waypoint& from = waypoints_[target.waypoint];
    target.buttons = from.buttons;
    target.X_DT = from.X_DT;
    if (after == waypoints_.end()) return target;

    const double span = after->time - from.time;
    const double u = (t - from.time) / span;
    const double s = u * u * (3 - 2 * u);
    const double s_rate = 6 * u * (1 - u) / span;
    const Eigen::Vector3d way = after->X_DT.position - from.X_DT.position;
    const Eigen::Vector3d& turn = turns_[target.waypoint];
    target.X_DT = from.X_DT.incremented(s * way, s * turn);
    target.v_DT = s_rate * way;
    target.w_DT = s_rate * turn;
    return target;
}

void OperatorPath::addTremor(double t, HandTarget& target) const noexcept {
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 3; ++k) {
            const double w = 2 * std::numbers::pi * kTremorFrequencies_hz[axis][k];
            const double angle = w * t + kTremorPhases_rad[axis][k];
            target.X_DT.position[axis] += tremor_ / 3 * std::sin(angle);
            target.v_DT[axis] += tremor_ / 3 * w * std::cos(angle);
        }
    }
}

AresEmulator::AresEmulator(const AresKinematics& kinematics, const AresPlant& plant,
                           const HandImpedance& hand, const OperatorPath& path)
    : kinematics_(kinematics), plant_(plant), hand_(hand), path_(path) {
    state_.target = path_.at(0);
    state_.target.buttons = 0;
    state_.X_DT = state_.target.X_DT;
    kinematics_.inverse(state_.X_DT, q_links_);
}

void AresEmulator::advance(double dt, const Vector6d& actuator_forces) noexcept {
    if (!(dt > 0)) return;
    const int substeps = static_cast<int>(std::ceil(dt * kSubstepRate_hz - kRoundingSlack));
    for (int i = 0; i < substeps; ++i) substep(dt / substeps, actuator_forces);
}

bool AresEmulator::readJoints(double elapsed, JointReading& reading) noexcept {
    advance(std::min(elapsed, kLongestElapsed), held_forces_);
    reading = {};
    reading.status = kStatusPowered | kStatusCalibrated | kStatusDriving;
    reading.forces = state_.actuator_forces;
    reading.buttons = state_.target.buttons;
    kinematics_.inverse(state_.X_DT, reading.q);  // always reachable: moveBody() never leaves the workspace
    Matrix6d J_inv;
    if (kinematics_.inverseJacobian(state_.X_DT, J_inv)) {
        reading.q_dot = J_inv * (Vector6d() << state_.v_DT, state_.w_DT).finished();
    }
    if (plant_.play > 0) {
        moveSliders(reading.q);
        reading.q += slider_offsets_;
    }
    if (plant_.encoder_step > 0) {
        reading.q = (reading.q / plant_.encoder_step).array().round() * plant_.encoder_step;
    }
    return true;
}

void AresEmulator::moveSliders(const Vector6d& q_links) noexcept {
    const double side = plant_.play / 2;
    for (int i = 0; i < 6; ++i) {
        const double force = state_.actuator_forces[i];
        const double dragged = std::clamp(slider_offsets_[i] + q_links_[i] - q_links[i], -side, side);
        slider_offsets_[i] = std::abs(force) > kSliderFriction ? std::copysign(side, force) : dragged;
    }
    q_links_ = q_links;
}

void AresEmulator::moveHand(double h) noexcept {
    const bool draws_back = !scenario_runs_ || is_going_back_;
    if (!draws_back && retreat_ == 0) {
        state_.scenario_time += h;
        state_.target = path_.at(state_.scenario_time);
        return;
    }
    if (state_.scenario_time == 0) return;
    const double step = h / kRetreatTime;
    const double next = std::clamp(retreat_ + (draws_back ? step : -step), 0.0, 1.0);
    const double rate = 6 * next * (1 - next) * (next - retreat_) / h;
    retreat_ = next;
    const HandTarget there = path_.at(state_.scenario_time);
    const Pose start = path_.at(0).X_DT;
    const Eigen::Vector3d way = start.position - there.X_DT.position;
    const Eigen::Vector3d turn = logRotation(start.rotation * there.X_DT.rotation.conjugate());
    const double share = retreat_ * retreat_ * (3 - 2 * retreat_);
    state_.target = {.X_DT = there.X_DT.incremented(share * way, share * turn),
                     .v_DT = rate * way,
                     .w_DT = rate * turn,
                     .buttons = 0,
                     .waypoint = there.waypoint};
    if (!is_going_back_ || retreat_ < 1) return;
    is_going_back_ = false;
    state_.scenario_time = retreat_ = 0;
}

void AresEmulator::substep(double h, const Vector6d& actuator_forces) noexcept {
    moveHand(h);
    const double settled = -std::expm1(-2 * std::numbers::pi * plant_.amplifier_bandwidth_hz * h);
    state_.actuator_forces += settled * (actuator_forces - state_.actuator_forces);

    Matrix6d J_inv;
    if (kinematics_.inverseJacobian(state_.X_DT, J_inv)) {
        pushBody(h, wrenchOf(J_inv, state_.actuator_forces));
        moveBody(h);
    }
}

void AresEmulator::pushBody(double h, const Wrench& drive) noexcept {
    const double mass = plant_.moving_mass + hand_.mass;
    const double inertia = plant_.moving_inertia + hand_.inertia;
    const HandTarget& target = state_.target;

    Eigen::Vector3d pull = hand_.stiffness * (target.X_DT.position - state_.X_DT.position);
    pull.z() -= kGravity * plant_.unbalanced_mass;
    const double damping = plant_.viscous_friction + hand_.damping + (is_braked_ ? kBrakeDamping : 0);
    Eigen::Vector3d momentum = mass * state_.v_DT + h * (drive.force + pull + hand_.damping * target.v_DT);
    // Coulomb friction is implicit: it takes momentum, at most all of it.
    const double friction = h * plant_.coulomb_friction;
    const double size = momentum.norm();
    momentum *= size > friction ? 1 - friction / size : 0.0;
    state_.v_DT = momentum / (mass + h * damping);

    const Eigen::Vector3d twist =
        hand_.angular_stiffness * logRotation(target.X_DT.rotation * state_.X_DT.rotation.conjugate());
    const double angular_damping =
        plant_.angular_friction + hand_.angular_damping + (is_braked_ ? kBrakeAngularDamping : 0);
    state_.w_DT = (inertia * state_.w_DT + h * (drive.torque + twist + hand_.angular_damping * target.w_DT)) /
                  (inertia + h * angular_damping);
}

void AresEmulator::moveBody(double h) noexcept {
    const Pose next = state_.X_DT.incremented(h * state_.v_DT, h * state_.w_DT);
    state_.at_stop = kinematics_.workspaceFaults(next) != kWorkspaceOk;
    if (state_.at_stop) {
        state_.v_DT.setZero();
        state_.w_DT.setZero();
    } else {
        state_.X_DT = next;
    }
}

}  // namespace bonemill
