// Reads the device poses that `simulate` feeds to the tick: CSV with the header
// t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons (any order, further columns are ignored), one row per tick.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

struct TrajectoryRow {
    double t_s = 0.0;
    Pose X_WT;             // of the device; its quaternion as written, which the tick normalises
    uint32_t buttons = 0;  // Button bits
};

// There is at least one row, and t_s is strictly increasing. Throws UserError with file:line for a missing
// column, a cell that is no finite number, a quaternion whose norm is off by more than 1e-3 and a time that does not increase.
std::vector<TrajectoryRow> readTrajectory(const std::string& path);
// Reads the same from a stream; `name` stands for the file in messages.
std::vector<TrajectoryRow> readTrajectory(std::istream& input, const std::string& name);

}  // namespace bonemill
