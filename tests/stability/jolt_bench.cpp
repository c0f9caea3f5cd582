#include "tests/stability/jolt_bench.h"

#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

constexpr double kRecovered = 0.1;  // N

ToolModel ballModel(double radius) {
    return sphereToolModel(radius, kVoxel);
}

Burr withRadius(Burr burr, double radius) {
    burr.radius = radius;
    return burr;
}

}  // namespace

JoltBench::JoltBench(VoxelVolume volume, const Variant& variant, const Vector3d& start,
                     const std::function<void(FixedTickConfig&)>& edit)
    : scene_(
          std::move(volume), burr(), variant, kDt,
          [&](FixedTickConfig& config) {
              config.tool.saturation_force = kMaxPull;
              if (edit) edit(config);
          },
          true),
      history_(scene_.bone),
      small_(ballModel(kSmall)),
      large_(ballModel(kLarge)),
      tools_({scene_.spoTool(),
              {&small_, withRadius(scene_.config.tool.burr, kSmall), kMaxPull},
              {&large_, withRadius(scene_.config.tool.burr, kLarge), kMaxPull}}),
      stepper_(scene_, &tools_, &history_),
      quick_stiffness_(scene_.handSide().spring.stiffness),
      drag_(scene_.config.gradient.coupling.damping_time *
            scene_.config.gradient.coupling.translation_stiffness),
      hand_(upright(start)) {
    stepper_.step(hand_);
    settle();
}

void JoltBench::settle(int ticks) {
    run(ticks);
    figures_ = {};
    forces_.erase(forces_.begin(), forces_.end() - 1);
    recovering_from_ = 0;
}

void JoltBench::run(int ticks, const Vector3d& velocity, uint32_t buttons) {
    for (int n = 0; n < ticks; ++n) {
        hand_.position += kDt * velocity;
        step(hand_, velocity, buttons);
    }
}

void JoltBench::runFalse(int ticks, const Pose& sample, const Vector3d& velocity) {
    for (int n = 0; n < ticks; ++n) {
        hand_.position += kDt * velocity;
        step(sample, velocity, 0);
    }
}

void JoltBench::step(const Pose& sample, const Vector3d& velocity, uint32_t buttons) {
    stepper_.step(sample, buttons);
    const Vector3d force = stepper_.wrenchOnHand().force;
    const Vector3d before = forces_.empty() ? force : forces_.back();
    const double explained = quick_stiffness_ * kDt * velocity.norm() + drag_ * (velocity - velocity_).norm();
    figures_.jolt = std::max(figures_.jolt, (force - before).norm() - explained);
    figures_.on_side = figures_.on_side && !(wrong_side_ && wrong_side_(stepper_.spo().position));
    figures_.is_finite = figures_.is_finite && force.allFinite() && stepper_.spo().isFinite();
    velocity_ = velocity;
    forces_.push_back(force);
}

JoltFigures JoltBench::figures() const {
    JoltFigures figures = figures_;
    size_t last_off = recovering_from_;
    for (size_t n = recovering_from_; n < forces_.size(); ++n)
        if (!((forces_[n] - forces_.back()).norm() < kRecovered)) last_off = n + 1;
    figures.recovery = kDt * double(last_off - recovering_from_);
    return figures;
}

}  // namespace bonemill::test
