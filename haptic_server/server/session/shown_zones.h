// Viewers see the zones of a task as materials: they have their colours beside those of the scene's
// materials, and vertices their numbers. Used at start-up; allocates.
#pragma once

#include <optional>

#include "haptic_server/assessment/product/judged_task.h"
#include "haptic_server/surface/mesh/zone_paint.h"
#include "proto/scene.pb.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Adds the zones behind the scene's materials, if viewers may ever see them.
void describeZones(const scene::Scene& scene, topics::SceneInfo& info);

// What is gone of leeway, container, protected and context zones shows, and what is left of targets. None
// where viewers never see it. `scanned` must outlive it.
std::optional<ZonePaint> zonePaintOf(const scene::Scene& scene, const JudgedTask* task,
                                     const VoxelVolume& scanned);

}  // namespace bonemill
