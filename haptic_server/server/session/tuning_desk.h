// Clients tune the contact law of a live session here (docs/howto/tune.md): what they ask
// for is checked, made for the tick, noted in the journal, and only then chosen. All members belong to the
// publisher thread, or to whoever runs none beside it.
#pragma once

#include <map>
#include <string>

#include "common/commands/answer.h"
#include "haptic_server/scene/setup/tunable_scene.h"
#include "haptic_server/server/session/journal_notes.h"
#include "proto/topics.pb.h"

namespace bonemill {

class TuningDesk {
  public:
    // All must outlive this object.
    TuningDesk(const TunableScene& scene, TuningSwitch& tunings, JournalRecorder& journal)
        : scene_(scene), tunings_(tunings), journal_(journal) {}

    // These values, and no others, are in force from now on, in place of the scene's own.
    Answer tune(const scene::Tuning& values);
    // The journal has begun: it learns what is in force.
    void noteInForce();
    // Fills in what is tuned, if anything is.
    void describe(topics::Status& status) const;

  private:
    const TunableScene& scene_;
    TuningSwitch& tunings_;
    JournalRecorder& journal_;
    scene::Tuning values_;                   // in force
    std::map<std::string, uint32_t> known_;  // tunings_' numbers by their text
};

}  // namespace bonemill
