// What the measures of technique look at: the scene, and one tick after the other, with the time since the
// one before. SI, frame W. Plain values.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "haptic_server/core/telemetry/recorded_effects.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

// What the measures of technique must know of the scene.
struct TechniqueScene {
    RecordedEffects recorded;            // what the records hold
    std::vector<std::string> materials;  // names, in the scene's order
    std::vector<bool> are_protected;     // of the materials; those that are not named here are not
    std::vector<std::string> tools;      // names, in the scene's order
    // In contact, a force beyond this is too much; 0: no such limit.
    double force_limit = 0;  // N

    bool isProtected(size_t material) const {
        return material < are_protected.size() && are_protected[material];
    }
};

struct TickStep {
    const TickRecord& record;
    double dt;  // s since the tick before; 0: the first one, or time was lost in between

    double t() const noexcept { return record.t_s; }
    bool isInContact() const noexcept { return record.contacts > 0; }
    Eigen::Vector3d p_W() const noexcept { return Eigen::Map<const Eigen::Vector3d>(record.p_WT); }
    Eigen::Vector3d f_W() const noexcept { return Eigen::Map<const Eigen::Vector3d>(record.f_hand_W); }
    double force() const noexcept { return f_W().norm(); }
    Eigen::Vector3d axis_W() const noexcept {  // along the shaft to the hand
        const double(&q)[4] = record.q_WT;
        return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::Vector3d::UnitY();
    }
    // To the nearest protected structure, m; nothing below infinity where none is in reach.
    double distance() const noexcept {
        return record.effects.protected_id != 0 ? double(record.effects.protected_distance)
                                                : std::numeric_limits<double>::infinity();
    }
};

}  // namespace bonemill
