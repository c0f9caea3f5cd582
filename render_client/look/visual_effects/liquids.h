// Blood and water on the bone. The frame is V, the units are m and s. They are for one thread. The same
// inputs and steps give the same film and drops.
#pragma once

#include <bitset>
#include <span>

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/bone_surface.h"
#include "render_client/look/visual_effects/effect_input.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

using MaterialSet = std::bitset<256>;

// This is the blood on the surface film: it seeps from fresh cuts after a delay, spreads, begins to run down
// in rivulets, and stops when it has clotted. The film's grid holds it; a cut through it takes it away.
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

// A stream of water runs from a nozzle on the handpiece to the burr, as long as the pedal is down. Where it
// meets bone it wets it, some of it runs down in drops; what meets the burr is thrown off.
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
