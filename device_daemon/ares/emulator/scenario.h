// This is the emulated ARES and the hand on it, as the scene file describes them: the one place where units
// and frames change. It is for start-up.
#pragma once

#include <string>
#include <vector>

#include "device_daemon/ares/driver/ares_emulator.h"
#include "proto/scene.pb.h"

namespace bonemill {

struct Scenario {
    double rate_hz = 1000;
    AresGeometry geometry;
    AresPlant plant;
    HandImpedance hand;
    OperatorPath path;                // waypoints moved from W to D
    std::vector<std::string> phases;  // of each waypoint; one without a phase goes on with the one before
    double max_actuator_force = 50;   // N
    double max_force = 50;            // N at the handle
    double max_torque = 1;            // N·m
};

// Throws UserError when the geometry cannot be built or the path leaves the device's workspace.
Scenario scenarioOf(const scene::Scene& scene);

// Returns the phase at this waypoint, for people.
std::string phaseOf(const Scenario& scenario, int waypoint);

}  // namespace bonemill
