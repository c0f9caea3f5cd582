#include "haptic_server/server/session/tuning_desk.h"

namespace bonemill {
namespace {

// What says the same as the scene file is not tuned.
scene::Tuning differing(const scene::Tuning& values, const scene::Tuning& of_scene) {
    scene::Tuning out;
    for (const LiveField& field : liveFields())
        if (const auto value = valueOf(values, field); value && value != valueOf(of_scene, field))
            setValue(out, field, *value);
    return out;
}

}  // namespace

Answer TuningDesk::tune(const scene::Tuning& values) {
    if (const std::string why_not = scene_.problem(values); !why_not.empty()) return Answer::refused(why_not);
    const scene::Tuning wanted = differing(values, scene_.ofScene());
    const std::string text = tuningText(wanted);
    uint32_t number = TuningSwitch::kOfScene;
    if (const auto known = known_.find(text); known != known_.end()) {
        number = known->second;
    } else if (!text.empty()) {
        number = tunings_.add(scene_.with(wanted));
        if (number == TuningSwitch::kOfScene)
            return Answer::refused("a scene takes " + std::to_string(TuningSwitch::kMost) +
                                   " tunings: choose it anew for more");
        known_[text] = number;
        journal_.noteTuned(number, wanted);
    }
    values_ = wanted;
    tunings_.choose(number);
    return Answer::done();
}

void TuningDesk::noteInForce() {
    if (tunings_.chosen() != TuningSwitch::kOfScene) journal_.noteTuned(tunings_.chosen(), values_);
}

void TuningDesk::describe(topics::Status& status) const {
    if (values_.ByteSizeLong() > 0) *status.mutable_tuning() = values_;
}

}  // namespace bonemill
