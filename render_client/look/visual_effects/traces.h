// What heat and pressure leave on bone and structures, on the surface film. The frame is V, the units are m
// and °C. They are for one thread. The same inputs give the same film.
#pragma once

#include <optional>

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/effect_input.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

// Bone under the burr browns while it gets hot. Told is only how hot the hottest bone is, not where: while
// that temperature does not fall, and the burr works, it is taken for that of the bone under the burr. A cut
// takes its brown away.
class Browning {
  public:
    explicit Browning(const scene::Browning& wish) : wish_(wish) {}

    void take(const EffectInput& input, SurfaceFilm& film);
    void clear() { before_c_.reset(); }

  private:
    scene::Browning wish_;
    std::optional<double> before_c_;  // the hottest bone of the input before
};

// What is protected reddens where the burr presses it, the more the harder, and most where it was damaged.
// Bone shows it as well where it lies within the burr's print.
class Bruising {
  public:
    static constexpr float kMostOfTouch = 0.6f;  // on the film; damage is 1

    explicit Bruising(const scene::Bruising& wish) : wish_(wish) {}

    void take(const EffectInput& input, SurfaceFilm& film) const;

  private:
    scene::Bruising wish_;
};

}  // namespace bonemill
