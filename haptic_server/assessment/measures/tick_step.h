// One tick as the measures of technique look at it: its record, and the time since the one before. SI, frame
// W. Plain values.
#pragma once

#include <Eigen/Geometry>

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

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
