// What is known of Force Dimension's arms by the type that the SDK reports, as published with the open
// CHAI3D; the SDK itself does not say how strong an arm is.
#pragma once

namespace bonemill::bridge {

struct SystemType {
    int type;
    const char* name;
    double max_force;         // N
    double max_torque;        // N·m; 0 for arms whose wrist has no motors
    double max_stiffness;     // N/m
    double workspace_radius;  // m
};

// An arm that is not in the table gets the limits of the weakest that is.
SystemType systemTypeOf(int type) noexcept;

}  // namespace bonemill::bridge
