// Gives the same numbers from the same seed everywhere. It is a plain value.
#pragma once

#include <Eigen/Core>
#include <random>

namespace bonemill {

class EffectRandom {
  public:
    explicit EffectRandom(uint32_t seed) : engine_(seed) {}

    float unit() { return float(engine_() >> 8) * 0x1p-24f; }  // 0 .. below 1
    float between(float low, float high) { return low + (high - low) * unit(); }
    // Returns a point in the cube of half edge 1. Each coordinate is drawn by itself, since the order of
    // arguments is the compiler's choice.
    Eigen::Vector3f inCube() {
        const float x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        return {x, y, z};
    }
    size_t below(size_t count) { return size_t(unit() * float(count)); }

  private:
    std::mt19937 engine_;
};

}  // namespace bonemill
