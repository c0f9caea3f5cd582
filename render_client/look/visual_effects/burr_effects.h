// What the turning burr shows: its flutes, and grains of removed bone. The frame is V, the units are m and s.
// They are for one thread. The same inputs and steps give the same grains.
#pragma once

#include "proto/scene.pb.h"
#include "render_client/look/visual_effects/bone_surface.h"
#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {

// It says how the burr's flutes stand, and how far they turn while one picture is shown.
struct BurrTurn {
    float angle = 0;  // rad about T's +y, of the flutes
    float sweep = 0;  // rad that they turned since the picture before, signed
    float flutes = 8;
};

class BurrSpin {
  public:
    explicit BurrSpin(const scene::BurrSpin& wish) { turn_.flutes = float(wish.flutes()); }

    void advance(double dt, double spin_speed);
    // Returns the turn for the next picture. While no time passes it stays the same.
    BurrTurn takeTurn();

  private:
    double angle_ = 0, swept_ = 0, time_ = 0;
    BurrTurn turn_;
};

// These are grains of removed bone: they leave the burr's rim with its spin, fly with drag, bounce off the
// bone and come to rest on it, fade, or are washed away. Grains neither touch each other nor the tool.
class BoneDust {
  public:
    explicit BoneDust(const scene::BoneDust& wish);

    void take(const EffectInput& input);
    void advance(double dt, const BoneSurface& surface);
    // Resting grains within `radius` are carried off, each with this chance.
    void wash(const Eigen::Vector3f& p_V, float radius, float chance);
    void clear() { grains_.clear(); }

    void appendTo(Particles& particles) const;
    size_t count() const { return grains_.size(); }
    size_t restingCount() const;

  private:
    struct Grain {
        Eigen::Vector3f p, v;
        float radius, age, shade;
        bool is_resting;
    };
    void launch(float age);
    void fly(Grain& grain, float dt, const BoneSurface& surface);
    void meetBone(Grain& grain, const BoneSurface& surface);

    scene::BoneDust wish_;
    EffectRandom random_{20121};
    EffectInput input_;
    double due_ = 0;             // grains that have not left yet
    size_t next_ = 0;            // oldest, once the pool is full
    std::vector<Grain> grains_;  // at most most_grains
};

}  // namespace bonemill
