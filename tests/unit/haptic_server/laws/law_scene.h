// The laws of other schools on analytic bone: a law with its tool, made a tick at a time.
#pragma once

#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/laws/all_laws.h"
#include "haptic_server/laws/constraint_law.h"
#include "haptic_server/laws/penalty_sdf.h"
#include "haptic_server/laws/vps.h"
#include "tests/support/contact_scene.h"

namespace bonemill::test {

inline constexpr double kLawVoxel = 0.125e-3, kLawTop = 2.5e-3, kLawRadius = 1e-3;
inline const Eigen::Vector3d kLawMiddle(2.53e-3, 2.47e-3, kLawTop);

// Bone fills what is below `normal`'s plane through kLawMiddle.
inline ContactScene lawPlane(const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ()) {
    return {cubeGeometry(41, kLawVoxel),
            halfSpace(kLawMiddle, normal),
            {SphereShape{{0, 0, 0}, kLawRadius}},
            {.levels = {{1}}}};
}

struct LawRun {
    LawRun(ContactLaw law, const ContactScene& scene, const Pose& start, double radius = kLawRadius)
        : tool{&scene.tool, {.radius = radius}, 50},
          laws(
              allLaws(),
              {config.contact, config.coupling, config.gradient, scene.world(), {&tool, 1}, tool, config.dt}),
          model(laws.of(law)),
          spo(start) {
        for (const Preset preset : kComparedLaws)
            if (presetSettings(preset).law == law) model.setAccuracy(presetSettings(preset));
        model.restart();
    }
    SpoStep to(const Pose& device) {
        const SpoStep step = model.advance(spo, device);
        spo = step.X_VT;
        return step;
    }
    SpoStep settle(const Pose& device, int ticks = 60) {
        SpoStep step;
        for (int n = 0; n < ticks; ++n) step = to(device);
        return step;
    }

    TickConfig config;
    SpoTool tool;
    SpoModels laws;
    SpoModel& model;
    Pose spo;
};

inline Pose uprightAt(const Eigen::Vector3d& position) {
    return {position, Eigen::Quaterniond::Identity()};
}

}  // namespace bonemill::test
