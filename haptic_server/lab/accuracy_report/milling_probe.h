// Measures how much bone the burr takes away, against the volume that it swept.
#pragma once

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/lab/accuracy_report/measures.h"
#include "haptic_server/lab/accuracy_report/probing_path.h"

namespace bonemill {

// Goes into the bone at a place and sideways, slowly enough for the scene's removal rate, then rests until
// all is gone that the burr can reach.
PosePath millingPath(const ProbingPlace& place, const FixedTickConfig& tick);

struct MillingRun {
    RunRecords records;
    double removed = 0;  // m³ between the trilinear surfaces before and after
    double swept = 0;    // m³ of bone inside the burr at any pose of the simulated tool
    double wanted = 0;   // m³ of bone inside the burr at any pose of the device
};

// Mills and puts the bone back with `history`, which must have been made from it.
MillingRun millAndRestore(const FixedTickConfig& tick, BoneModel& bone, BoneHistory& history,
                          const PosePath& path);

}  // namespace bonemill
