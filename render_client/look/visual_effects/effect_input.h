// What the viewer's effects have in common: the tool state that they take, bounded whatever came over the
// network, particles and chance. They are plain values. The frame is V, the units are SI.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"

namespace bonemill {

constexpr float kGravity = 9.81f;  // m/s²

// The particle painter draws this as a small ball, or as a streak from p to p + streak.
struct Particle {
    Eigen::Vector3f p_V, streak_V;
    float radius;
    Eigen::Vector4f colour;  // linear; w: opacity
    float gloss;             // 0 matt .. 1 water
};

using Particles = std::vector<Particle>;

// Gives the same numbers from the same seed everywhere.
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

// Poses and boxes of the topics' messages are checked: what came over the network may be anything.
using WireVector = google::protobuf::RepeatedField<double>;

// Returns three finite numbers, or nothing.
inline std::optional<Eigen::Vector3d> readVector(const WireVector& v) {
    if (v.size() != 3) return std::nullopt;
    const Eigen::Vector3d vector(v[0], v[1], v[2]);
    if (!vector.allFinite()) return std::nullopt;
    return vector;
}

// Returns position (m) and quaternion (w, x, y, z; normalised here), or nothing.
inline std::optional<Pose> readPose(const WireVector& position, const WireVector& quaternion) {
    const auto p = readVector(position);
    if (!p || quaternion.size() != 4) return std::nullopt;
    const Eigen::Quaterniond q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
    const double norm = q.norm();
    if (!(norm > 1e-6) || !std::isfinite(norm)) return std::nullopt;
    return Pose{*p, q.normalized()};
}

// It is a tool state as the effects take it.
struct EffectInput {
    std::optional<Pose> X_VT;  // the simulated tool
    double burr_radius = 0;
    bool is_pedal_down = false;
    double spin_speed = 0;                                            // rad/s about T's +y
    double burr_force = 0;                                            // N
    double cutting_power = 0;                                         // W
    double removed = 0;                                               // m³ since the input before
    std::optional<double> hottest_c;                                  // °C, of the bone
    double protected_force = 0;                                       // N on protected structures
    bool is_protected_touched = false, is_protected_damaged = false;  // since the input before
    Eigen::Vector3d towards_bone_V = Eigen::Vector3d::Zero();         // unit, from the force; 0: not touching
    Eigen::Vector3d up_V = Eigen::Vector3d::UnitZ();                  // unit, against gravity

    // Where the burr presses on what it touches (V); there must be a pose.
    Eigen::Vector3f contact() const { return (X_VT->position + burr_radius * towards_bone_V).cast<float>(); }
};

// The bounds are ±25,000 rad/s, 1000 N, 1000 °C, 10 kW, 100 mm³ and 0.1 to 50 mm for the burr. It is for any
// thread and never throws.
EffectInput effectInputOf(const topics::ToolState& tool, const topics::SceneInfo& info);

}  // namespace bonemill
