// The simulated ARES with a simulated hand on its handle is one coupled dynamic system driven
// by actuator forces.
//
// The six amplifiers, each with a first-order pole, push the sliders. The handle with everything that moves
// along is one rigid body of isotropic mass and inertia, with viscous friction, and with Coulomb friction
// against translation. The hand's mass rides on it, and its spring and damper pull towards the OperatorPath.
// Gravity is balanced as on a counterweighted device, but for the mass that a scene says. The encoders report
// slider positions in whole steps. Sliders have no mass: where there is play, each lies at the side of the
// gap to which its motor pushes it, and a motor without force lets the link drag it along. All is integrated
// at 25 kHz or finer (semi-implicit Euler; damping and Coulomb friction implicit, so that the body truly
// sticks). Leaving the workspace is stopped dead, like running into a mechanical stop.
//
// It lives in the caller's time, and is deterministic: the same forces give the same motion bit for bit. It
// is not thread-safe, and RT-safe after construction.
#pragma once

#include <cstdint>
#include <vector>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/geometry/pose.h"
#include "device_daemon/ares/driver/joint_device.h"

namespace bonemill {

// Says where the simulated hand wants the handle, as a function of the scenario's time. Waypoints are in D.
// Each segment runs along a straight line and one rotation axis with a smoothstep in time (3s² - 2s³), which
// starts and stops at rest. Before the first and after the last waypoint the hand rests there. Tremor, if
// wanted, is three sines per axis between 8 and 12 Hz with fixed phases, so that a run can be repeated.
// Building allocates.
struct Waypoint {
    double time = 0;       // s, strictly increasing along the path
    Pose X_DT;             // wanted handle pose
    uint32_t buttons = 0;  // held from this waypoint on: bit 0 remove, bit 1 add
};

struct HandTarget {
    Pose X_DT;
    Eigen::Vector3d v_DT = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d w_DT = Eigen::Vector3d::Zero();  // rad/s, in D
    uint32_t buttons = 0;
    int waypoint = -1;  // the one last passed, -1 before the first
};

class OperatorPath {
  public:
    // Without a waypoint the hand rests at D's origin for ever. `tremor` is the largest deflection per axis.
    explicit OperatorPath(std::vector<Waypoint> waypoints = {}, double tremor = 0);

    HandTarget at(double t) const noexcept;
    // Returns the time of the last waypoint; 0 without waypoints.
    double duration() const noexcept { return waypoints_.empty() ? 0 : waypoints_.back().time; }

  private:
    HandTarget withoutTremor(double t) const noexcept;
    void addTremor(double t, HandTarget& target) const noexcept;

    std::vector<Waypoint> waypoints_;
    std::vector<Eigen::Vector3d> turns_;  // rotation vector (D) from waypoint i to i + 1
    double tremor_;
};

// The defaults lie in the middle of what such devices have.
struct AresPlant {
    double moving_mass = 0.25;        // kg
    double moving_inertia = 1e-4;     // kg·m², about every axis
    double viscous_friction = 2;      // N·s/m
    double angular_friction = 0.004;  // N·m·s/rad
    double coulomb_friction = 0.2;    // N, against translation
    double amplifier_bandwidth_hz = 500;
    double encoder_step = 5e-6;  // m; 0 is an ideal encoder
    double unbalanced_mass = 0;  // kg of the moving mass that its weight pulls along -z of D
    double play = 0;             // m, between each slider and its link
};

// If all is zero, no hand holds the handle.
struct HandImpedance {
    double mass = 0.1;               // kg
    double damping = 8;              // N·s/m
    double stiffness = 600;          // N/m
    double inertia = 5e-5;           // kg·m²
    double angular_damping = 0.02;   // N·m·s/rad
    double angular_stiffness = 1.0;  // N·m/rad
};

struct EmulatorState {
    Pose X_DT;                                       // the true handle pose, before quantisation
    Eigen::Vector3d v_DT = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d w_DT = Eigen::Vector3d::Zero();  // rad/s, in D
    Vector6d actuator_forces = Vector6d::Zero();     // N, after the amplifiers
    HandTarget target;                               // what the hand pulls towards
    double scenario_time = 0;                        // s
    bool at_stop = false;                            // the last substep ran into the workspace's limits
};

class AresEmulator final : public JointDevice {
  public:
    // Starts at rest where the path starts, which must be inside the workspace. Mass and inertia of plant and
    // hand together must be positive.
    AresEmulator(const AresKinematics& kinematics, const AresPlant& plant, const HandImpedance& hand,
                 const OperatorPath& path);

    // Lets the scenario's time run; before that the hand rests at the path's start with no button pressed.
    void startScenario() noexcept { scenario_runs_ = true; }
    // Holds the scenario's time; the hand lets the buttons go and draws the handle back to where the path
    // starts, as a person does who feels nothing any more. When the scenario goes on it first returns.
    void pauseScenario() noexcept { scenario_runs_ = false; }
    // The scenario's time goes back to its beginning, once the hand has drawn back as in a pause.
    void beginAnew() noexcept { is_going_back_ = state_.scenario_time > 0; }

    // The hand has passed its last waypoint, and does not begin anew. Who only rests at one never ends.
    bool hasEnded() const noexcept {
        return path_.duration() > 0 && state_.scenario_time >= path_.duration() && !is_going_back_;
    }

    // Shorts the motors' windings or opens them again: shorted, they brake every motion. The amplifiers must
    // then be told to give nothing.
    void setBraked(bool is_braked) noexcept { is_braked_ = is_braked; }

    // Moves the plant by dt with these amplifier inputs.
    void advance(double dt, const Vector6d& actuator_forces) noexcept;

    // Advances under the forces applied last, by kLongestElapsed at most, and returns the quantised joints.
    bool readJoints(double elapsed, JointReading& reading) noexcept override;
    void applyForces(const JointOrder& order) noexcept override { held_forces_ = order.forces; }

    // This bounds the work of one call after a long pause of the loop; for the rest the emulated
    // world stands still.
    static constexpr double kLongestElapsed = 0.05;  // s

    const EmulatorState& state() const noexcept { return state_; }

  private:
    void moveHand(double h) noexcept;
    void substep(double h, const Vector6d& actuator_forces) noexcept;
    void pushBody(double h, const Wrench& drive) noexcept;
    void moveBody(double h) noexcept;
    void moveSliders(const Vector6d& q_links) noexcept;

    AresKinematics kinematics_;
    AresPlant plant_;
    HandImpedance hand_;
    OperatorPath path_;
    Vector6d held_forces_ = Vector6d::Zero();
    Vector6d slider_offsets_ = Vector6d::Zero();  // m, from the links, within the play
    Vector6d q_links_ = Vector6d::Zero();         // m, where the links were read last
    bool scenario_runs_ = false;
    double retreat_ = 0;          // way of the hand back to the start, 0 to 1
    bool is_going_back_ = false;  // to the scenario's beginning
    bool is_braked_ = false;
    EmulatorState state_;
};

}  // namespace bonemill
