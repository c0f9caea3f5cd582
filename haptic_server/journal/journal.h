// A session's journal: what its threads tell of it goes into an MCAP file that only grows (docs/recording.md).
// A kill loses the last 250 ms at most, the loss of power a second. Nothing waits for the disk: where it is
// full or too slow the journal says from which tick on it is incomplete, and the session goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_server/bone/bone_snapshot.h"
#include "haptic_server/journal/bone_states.h"
#include "haptic_server/journal/input_columns.h"
#include "haptic_server/journal/journal_file.h"
#include "haptic_server/journal/journal_topics.h"
#include "haptic_server/telemetry/recorded_effects.h"

namespace bonemill {

class Journal {
  public:
    // Any normal thread: this message, serialized, belongs to the topic. It is in the file 250 ms later.
    void put(JournalTopic topic, const google::protobuf::MessageLite& message);
};

}  // namespace bonemill
