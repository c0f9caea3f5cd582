// Visual effects add this to one picture. They are plain values in the frame V, with units m and rad.
#pragma once

#include <optional>

#include "render_client/look/visual_effects/burr_spin.h"
#include "render_client/look/visual_effects/particle.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

struct EffectPicture {
    Particles particles;           // dust, water
    std::optional<BurrTurn> turn;  // of the burr's flutes
    bool shows_blood = false, shows_water = false;
    Eigen::Vector3f blood_colour = Eigen::Vector3f::Zero();  // linear
    SurfaceFilm* film = nullptr;  // where blood and water lie on the bone; its changes are taken
};

}  // namespace bonemill
