// A simulated hand that mills the block of every_effect_scene.h.
#pragma once

#include "tests/support/every_effect_scene.h"

namespace bonemill::test {

// The hand goes down into the block and to and fro there, with the pedal, for as long as a test takes.
inline void addHand(scene::Scene& scene, const EveryEffectBlock& block) {
    const double middle = block.edge * block.voxel_mm / 2, face = middle + block.burr_radius_mm;
    const auto add = [&](double time_s, double x, double z, bool removes) {
        auto& point = *scene.mutable_simulated_operator()->add_waypoint();
        point.set_time_s(time_s);
        point.mutable_p_wt_mm()->set_x(x), point.mutable_p_wt_mm()->set_y(middle);
        point.mutable_p_wt_mm()->set_z(z);
        point.mutable_q_wt()->set_w(0.6), point.mutable_q_wt()->set_x(0.77);
        point.mutable_q_wt()->set_y(0.2), point.mutable_q_wt()->set_z(0.0843);
        point.set_remove(removes);
    };
    add(0, middle, face + 0.4, false);
    add(0.5, middle, face + 0.1, true);
    for (int n = 0; n < 60; ++n) add(1.5 + n, middle + (n % 2 ? 1.2 : -1.2), face - 0.3 - 0.02 * n, true);
    scene.mutable_simulated_operator()->set_tremor_mm(0.02);
    scene.mutable_simulated_operator()->set_hand_stiffness_n_per_m(2000);
    auto& place = *scene.mutable_device()->mutable_p_wd_mm();
    place.set_x(middle), place.set_y(middle), place.set_z(face);
    *scene.mutable_device()->mutable_q_wd() = scene.simulated_operator().waypoint(0).q_wt();
}

}  // namespace bonemill::test
