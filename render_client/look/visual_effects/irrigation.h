// A stream of water runs from a nozzle on the handpiece to the burr, as long as the pedal is down. Where it
// meets bone it wets it, some of it runs down in drops; what meets the burr is thrown off.
//
// The frame is V, the units are m and s. It is for one thread. The same inputs and steps give the same drops.
#pragma once

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/bone_surface.h"
#include "render_client/look/visual_effects/effect_input.h"
#include "render_client/look/visual_effects/effect_random.h"
#include "render_client/look/visual_effects/particle.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

class Irrigation {
  public:
    explicit Irrigation(const scene::Irrigation& wish) : wish_(wish) {}

    void take(const EffectInput& input) { input_ = input; }
    // Leaves the places where water met bone in landed().
    void advance(double dt, const BoneSurface& surface, SurfaceFilm& film);
    void dry(double dt, SurfaceFilm& film) const;
    void clear() { drops_.clear(); }

    const std::vector<Eigen::Vector3f>& landed() const { return landed_; }
    // Returns the part of the blood that stays where water flowed for so long (s).
    float washFactor(double dt) const;

    void appendTo(Particles& particles) const;
    size_t count() const { return drops_.size(); }

  private:
    static constexpr size_t kMaxDrops = 800;
    enum class State { kStream, kSpray, kRunning };
    struct Drop {
        SurfacePoint at;  // the normal counts while it runs
        Eigen::Vector3f v = Eigen::Vector3f::Zero();
        float radius = 0, age = 0, life = 0;
        State state = State::kStream;
    };
    void pour(double dt);
    // Returns false when the drop is gone.
    bool move(Drop& drop, float dt, const BoneSurface& surface, SurfaceFilm& film);
    bool run(Drop& drop, float dt, const BoneSurface& surface, SurfaceFilm& film);
    bool meetBurr(Drop& drop, SurfaceFilm& film);
    bool meetBone(Drop& drop, const BoneSurface& surface, SurfaceFilm& film);
    Eigen::Vector3d nozzle_T() const;
    float streamRadius() const;

    scene::Irrigation wish_;
    EffectRandom random_{83};
    EffectInput input_;
    double due_ = 0;
    std::vector<Drop> drops_;
    std::vector<Eigen::Vector3f> landed_;
};

}  // namespace bonemill
