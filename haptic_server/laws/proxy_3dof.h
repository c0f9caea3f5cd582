// proxy_3dof: a ball that the hand drags over the bone by a spring, and that never enters it. Only the burr's
// ball touches, the shaft does not, and there is no torque: the orientation is the hand's.
//
// After Zilles and Salisbury, "A constraint-based god-object method for haptic display", IROS 1995, with the
// ball in place of their point after Ruspini, Kolarov and Khatib, "The haptic display of complex graphical
// environments", SIGGRAPH 1997. docs/explanation/laws.md says what it is good for.
#pragma once

#include "haptic_server/core/tool/shape_field.h"
#include "haptic_server/laws/blocked_motion.h"
#include "haptic_server/laws/compared_law.h"

namespace bonemill {

class Proxy3Dof final : public ComparedLaw {
  public:
    Proxy3Dof(const LawConfig& config, const SpoWorld& world, const SpoTool& tool, double dt)
        : ComparedLaw(config, world, tool, dt), ball_({ballOf(tool)}) {}

    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override {
        SpoStep step;
        Pose proxy{X_VT.position, X_VT_device.rotation};
        const BlockedMotion::Wish wish{.X_VT = X_VT_device,
                                       .K = Matrix6d::Identity(),
                                       .may_turn = false,
                                       .rounds = iterations(),
                                       .recovery = BlockedMotion::kRecovery * dt(),
                                       .bite = bite(),
                                       .most_move = config().steps.max_speed * dt(),
                                       .most_turn = 0};
        motion_.go(world(), level(), ball_, wish, proxy, step);
        feel(step, proxy, X_VT_device);
        step.wrench_hand_V.torque.setZero();
        return step;
    }
    void restart() noexcept override {
        ComparedLaw::restart();
        motion_.restart();
    }
    void setTool(const SpoTool& tool) noexcept override {
        ComparedLaw::setTool(tool);
        ball_.become(ballOf(tool));
    }

  private:
    static SphereShape ballOf(const SpoTool& tool) noexcept {
        return {Eigen::Vector3d::Zero(), tool.burr.radius};
    }

    ShapeField ball_;
    BlockedMotion motion_;
};

}  // namespace bonemill
