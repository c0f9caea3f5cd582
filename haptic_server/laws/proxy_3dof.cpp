#include "haptic_server/laws/proxy_3dof.h"

namespace bonemill {

void Proxy3Dof::setTool(const SpoTool& tool) noexcept {
    ComparedLaw::setTool(tool);
    ball_.become(ballOf(tool));
}

SpoStep Proxy3Dof::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
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

}  // namespace bonemill
