// How far open structures rise with the heart. The unit is m. It is for one thread; the same steps give the
// same rise.
#pragma once

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {

class Pulse {
  public:
    // `materials` are the scene's; by name those that pulsate are found.
    Pulse(const scene::Pulse& wish, const google::protobuf::RepeatedPtrField<scene::Material>& materials);

    void advance(double dt);
    // Of the structure with that number, 1 + its index in the scene's materials. It goes in steps: what has
    // not changed need not be drawn anew.
    float riseOf(uint32_t structure) const;

    // The share of the whole rise at this part (0 to 1) of a beat, as the pressure in an artery goes: up
    // within a sixth, down over the rest, with a second small wave.
    static double waveAt(double beat);

  private:
    double beats_per_s_, rise_;
    std::vector<bool> pulsates_;  // by structure
    double beat_ = 0;             // 0 to 1
};

}  // namespace bonemill
