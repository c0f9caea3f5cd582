// The particle painter draws this as a small ball, or as a streak from p to p + streak. The frame is V,
// the unit m.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bonemill {

constexpr float kGravity = 9.81f;  // m/s²

struct Particle {
    Eigen::Vector3f p_V, streak_V;
    float radius;
    Eigen::Vector4f colour;  // linear; w: opacity
    float gloss;             // 0 matt .. 1 water
};

using Particles = std::vector<Particle>;

}  // namespace bonemill
