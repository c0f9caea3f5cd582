// Viewers are told this of a scene's effects and materials. Used at start-up and by the
// publisher thread; allocates.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/telemetry/effect_figure.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/recording/statistics/effect_statistics.h"
#include "haptic_server/recording/statistics/event_sum.h"
#include "proto/scene.pb.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Says what viewers have to know of effects and materials, and nothing if the scene lists none.
void describeToViewers(const scene::Scene& scene, topics::SceneInfo& info);

// Puts there from where on the burr the distance to protected structures is measured; nothing in a scene
// without any.
void describeBurr(const scene::Scene& scene, const Burr& burr, topics::SceneInfo& info);

// The trainee is warned at this distance (m) of a structure: what the scene says, or else what it could have
// said.
double warningDistanceOf(const scene::Effects& effects);

// Adds the figures that are recorded, mean something and have a line in viewers.
void addLines(std::span<const EffectFigure> figures, const EffectRecord& newest,
              const RecordedEffects& recorded, topics::EffectState& state);

// This makes the effects part of the tool states of a session.
class ShownEffects {
  public:
    explicit ShownEffects(const scene::Effects& effects);
    // False says that tool states have no such part.
    bool areShown() const noexcept { return recorded_.any() || is_seen_; }
    // `newest` is the newest tick's; `events` and `removed` (m³) are those since the tool state before.
    topics::EffectState at(const EffectRecord& newest, const EventSum& events, double removed) const;
    // Says nothing without protected_structures and thermal.
    void describe(const EffectStatistics& statistics, const std::vector<std::string>& materials,
                  topics::Status& status) const;
    // The same for an attempt.
    void describe(const EffectStatistics& statistics, const std::vector<std::string>& materials,
                  topics::Attempt& attempt) const;

  private:
    bool hasTraining() const noexcept { return recorded_.heat || recorded_.protection; }
    void fill(const EffectStatistics& statistics, const std::vector<std::string>& materials,
              topics::Training& training) const;

    RecordedEffects recorded_;
    bool is_seen_ = false;  // a viewer has effects that follow the burr
};

}  // namespace bonemill
