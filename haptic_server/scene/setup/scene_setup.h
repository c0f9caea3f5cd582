// Turns a scene file into the SI configuration and the objects that the tick works on. It is
// for start-up only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/tunable_scene.h"
#include "haptic_server/scene/tool_build/build_tool.h"

namespace bonemill {

struct SceneTool {
    std::string name;
    BuiltTool built;
    TriangleSurface surface;
    Burr burr;
    double saturation_force;           // N
    scene::Tool::Handpiece handpiece;  // never AUTOMATIC
};

struct SceneSetup {
    TickConfig tick;
    AccuracySettings accuracy;
    std::unique_ptr<BoneModel> bone;
    std::shared_ptr<const Surroundings> surroundings = nullptr;  // null: the bone is all there is
    DensityMapping mapping;
    SegmentColors segment_colors;                                  // for shownSceneOf()
    double label_edge = 0;                                         // of ScannedMaterials
    std::shared_ptr<const LabelledStructures> labelled = nullptr;  // of ScannedMaterials
    std::vector<SceneTool> tools;                                  // at least one
    std::shared_ptr<const JudgedTask> task = nullptr;              // null: the scene has none
    bool lacks_patient_axes = false;                               // RawVolume
    Pose X_WD;                                                     // device base in the world
    TunableScene tunable = {};                                     // while the session runs
    std::vector<std::string> remarks;                              // for people: what was read or proposed
    std::vector<std::string> warnings;  // what the user would better change in the scene

    // They are meant for ToolSwitch and point into `tools`.
    std::vector<SpoTool> spoTools() const;
    // It has the first tool and the scene's accuracy from beginning to end.
    FixedTickConfig fixedTick() const { return {tick, spoTools().front(), accuracy}; }
};

// Who follows the tool for its breach beside the planned line of the task; none without such a line.
std::optional<BreachMonitor> breachWatchOf(const SceneSetup& simulation);

// Imports the volume, builds tree, shell and tools. Throws UserError.
SceneSetup setUpScene(const LoadedScene& loaded);

// Returns what the scene chooses, or the kind that suits a tool with this surface; never AUTOMATIC.
scene::Tool::Handpiece handpieceOf(const scene::Tool& tool, const TriangleSurface& surface);

TickConfig tickConfigOf(const scene::Scene& scene);
ToolConfig toolConfigOf(const LoadedScene& loaded, const scene::Tool& tool);

}  // namespace bonemill
