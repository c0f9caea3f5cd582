#include "haptic_server/recording/rerun/recorded_attempts.h"

namespace bonemill {

// Earlier releases did not say that they dropped one: it is there without its end, and another one begins.
std::vector<RecordedAttempt> recordedAttempts(const JournalContent& content) {
    std::vector<RecordedAttempt> attempts;
    bool is_running = false;
    for (const journal::Event& event : content.events) {
        const bool begins = event.has_attempt_began();
        if (is_running && (begins || event.has_attempt_dropped())) attempts.pop_back();
        if (is_running && event.has_attempt_ended()) {
            attempts.back().end = event.tick();
            attempts.back().time_s = event.attempt_ended().time_s();
        }
        if (begins)
            attempts.push_back({event.attempt_began(), event.bone_order(), event.tick(), UINT64_MAX, {}});
        is_running = begins || (is_running && !event.has_attempt_ended() && !event.has_attempt_dropped());
    }
    return attempts;
}

}  // namespace bonemill
