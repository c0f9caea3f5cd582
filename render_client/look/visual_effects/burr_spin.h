// It says how the burr's flutes stand, and how far they turn while one picture is shown. It is a plain value.
#pragma once

#include "proto/scene.pb.h"

namespace bonemill {

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

}  // namespace bonemill
