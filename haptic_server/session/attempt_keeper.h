// Begins and ends a trainee's attempt at the scene in force, and counts what it came to. All members belong
// to the publisher thread, or to whoever has joined it.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/bone/bone_history.h"
#include "haptic_server/session/lesson_book.h"
#include "haptic_server/session/recorder.h"
#include "haptic_server/session/shown_effects.h"

namespace bonemill {

class AttemptKeeper {
  public:
    // References must outlive this object.
    AttemptKeeper(LessonBook& book, Recorder& recorder, BoneHistory& history, double voxel_volume,
                  const scene::Scene& scene);

    // The answer is "done", or "refused: <why>". The bone goes back to the scan, and milling goes on.
    std::string start(const std::string& trainee);
    // "done", "refused: <why>", or "failed: <why>" if the attempt has ended but is not in the class table.
    std::string stop();
    // Counts the time, which rests while milling is paused: call at least some times per second.
    void round();

  private:
    std::string end();

    LessonBook& book_;
    Recorder& recorder_;
    BoneHistory& history_;
    double voxel_mm3_;
    ShownEffects effects_;
    std::vector<std::string> material_names_;
    double time_s_ = 0;
    int64_t counted_ns_ = 0;  // CLOCK_MONOTONIC until which it is counted
};

}  // namespace bonemill
