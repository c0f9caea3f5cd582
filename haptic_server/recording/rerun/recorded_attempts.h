// The attempts of a recorded session, as its journal has them. For normal threads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/recording/journal/journal_reader.h"

namespace bonemill {

struct RecordedAttempt {
    std::string trainee;
    uint64_t bone_order = 0;       // that puts the bone back for it
    uint64_t begin = 0;            // tick
    uint64_t end = UINT64_MAX;     // tick; UINT64_MAX: the recording ends before
    std::optional<double> time_s;  // without pauses, if it has ended
};

// In their order, which is their number from 1 on. One that was dropped counts as none.
std::vector<RecordedAttempt> recordedAttempts(const JournalContent& content);

}  // namespace bonemill
