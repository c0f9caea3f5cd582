// This is the blood on the surface film: it seeps from fresh cuts after a delay, spreads, begins to run down
// in rivulets, and stops when it has clotted. The film's grid holds it; a cut through it takes it away.
//
// The frame is V, the units are m and s. It is for one thread. The same inputs and steps give the same film.
#pragma once

#include <bitset>
#include <span>

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/bone_surface.h"
#include "render_client/look/visual_effects/effect_random.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

using MaterialSet = std::bitset<256>;

class Bleeding {
  public:
    // `bleeds` is indexed by SurfacePoint::material.
    Bleeding(const scene::Bleeding& wish, const MaterialSet& bleeds) : wish_(wish), bleeds_(bleeds) {}

    // Bone was cut here; only that of materials that bleed does.
    void open(std::span<const SurfacePoint> cut, const SurfaceFilm& film);
    // The burr has cut all within this ball: what bled there is gone.
    void cutAway(const Eigen::Vector3f& p_V, float radius);
    void advance(double dt, const Eigen::Vector3f& up_V, const BoneSurface& surface, SurfaceFilm& film);
    void clear();

    Eigen::Vector3f colour() const;  // linear
    size_t woundCount() const { return wounds_.size(); }

  private:
    static constexpr size_t kMaxWounds = 6000, kMaxRuns = 48;
    struct Wound {
        SurfacePoint at;
        float age, waited;  // s: in all, and since blood came from it
    };
    struct Run {
        SurfacePoint at;
        float left;  // m that it still goes
        float width;
    };
    void seep(double dt, SurfaceFilm& film);
    double feed(Wound& wound, SurfaceFilm& film);
    void beginRuns(double dt, const SurfaceFilm& film);
    void run(double dt, const Eigen::Vector3f& up_V, const BoneSurface& surface, SurfaceFilm& film);

    scene::Bleeding wish_;
    MaterialSet bleeds_;
    EffectRandom random_{47};
    std::vector<Wound> wounds_;
    std::vector<Run> runs_;
    size_t next_ = 0;  // of wounds_
    double runs_due_ = 0;
};

}  // namespace bonemill
