// What the trainee saw in a recorded session, as its journal has it. For normal threads.
#pragma once

#include <vector>

#include "haptic_server/rerun/recording.h"

namespace bonemill {

struct RecordedEye {
    uint64_t tick = 0;  // from which on it was known
    topics::Eye eye;    // with place and orientation, W
};

// In the order of ticks, and of ticks that there are. Reads the journal once more. Throws UserError.
std::vector<RecordedEye> recordedEyes(const Recording& recording);

}  // namespace bonemill
