// What a session's tuning makes of its scene for the tick (haptic_server/core/tick/tick_tuning.h). It is for
// normal threads, and never changes.
#pragma once

#include <string>

#include "common/config/live_fields.h"
#include "haptic_server/core/tick/tick_tuning.h"
#include "proto/scene.pb.h"

namespace bonemill {

class TunableScene {
  public:
    TunableScene() = default;
    // `finest_spacing` is the bone's, m. The volume itself and the effects are left out.
    TunableScene(const scene::Scene& scene, double finest_spacing);

    // What can be tuned, as the scene file says it.
    const scene::Tuning& ofScene() const noexcept { return of_scene_; }
    // Why it cannot be tuned so, a sentence; empty if it can.
    std::string problem(const scene::Tuning& tuning) const { return tuningProblem(tuning, of_scene_); }
    // With these fields in place of the scene's own, which have no problem().
    TickTuning with(const scene::Tuning& tuning) const;

  private:
    scene::Scene scene_;
    scene::Tuning of_scene_;
    double finest_spacing_ = 0;
};

}  // namespace bonemill
