// What the trainee saw in a recorded session, as its journal has it. For normal threads.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

struct RecordedEye {
    uint64_t tick = 0;        // from which on it was known
    Eigen::Vector3d p_WC;     // m
    Eigen::Quaterniond q_WC;  // as it was written
    double field_of_view;     // rad, vertical
};

// In the order of ticks, and of ticks that there are. Reads the journal once more. Throws UserError.
std::vector<RecordedEye> recordedEyes(const Recording& recording);

}  // namespace bonemill
