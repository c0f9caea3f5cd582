// Viewers are told this of a scene's effects, materials and zones, and of the device. Used at start-up and by
// normal threads; allocates.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/core/telemetry/effect_figure.h"
#include "haptic_server/core/telemetry/effect_record.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/tool/burr.h"
#include "haptic_server/recording/statistics/effect_statistics.h"
#include "haptic_server/surface/mesh/zone_paint.h"
#include "proto/scene.pb.h"
#include "proto/topics.pb.h"

namespace bonemill {

// What clients are shown of the device; `capabilities` is null as long as no device has told of itself.
topics::Device shownDevice(const TickRecord& record, const DeviceCapabilities* capabilities);

// Says what the session adapts to: "Touch: 3.3 N, no torque".
std::string deviceText(const DeviceCapabilities& capabilities);

// Viewers see the zones of a task as materials: they have their colours beside those of the scene's
// materials, and vertices their numbers. Adds the zones behind the scene's materials, if viewers may ever see
// them.
void describeZones(const scene::Scene& scene, topics::SceneInfo& info);
int shownZones(const scene::Scene& scene);  // so many it adds

// What is gone of leeway, container, protected and context zones shows, and what is left of targets. None
// where viewers never see it. `scanned` must outlive it.
std::optional<ZonePaint> zonePaintOf(const scene::Scene& scene, const JudgedTask* task,
                                     const VoxelVolume& scanned);

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
