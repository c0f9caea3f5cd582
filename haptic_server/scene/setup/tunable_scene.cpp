#include "haptic_server/scene/setup/tunable_scene.h"

#include "common/config/scene_tools.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

TunableScene::TunableScene(const scene::Scene& scene, double finest_spacing)
    : of_scene_(tunableOf(scene)), finest_spacing_(finest_spacing) {
    *scene_.mutable_tool() = scene.tool();
    *scene_.mutable_contact() = scene.contact();
    *scene_.mutable_coupling() = scene.coupling();
    *scene_.mutable_loop() = scene.loop();
    *scene_.mutable_device() = scene.device();
}

TickTuning TunableScene::with(const scene::Tuning& tuning) const {
    const scene::Scene scene = tunedScene(scene_, tuning);
    const TickConfig config = tickConfigOf(scene);
    TickTuning out{.thesis = config.coupling,
                   .gradient = config.gradient.coupling,
                   .contact = config.gradient.contact,
                   .hand = config.hand,
                   .saturation_forces = {}};
    for (const scene::Tool* tool : toolsOf(scene))
        out.saturation_forces.push_back(saturationForceOf(scene, *tool, finest_spacing_));
    return out;
}

}  // namespace bonemill
