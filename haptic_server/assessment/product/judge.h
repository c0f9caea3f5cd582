// A task as a scene says it, in SI and frame V: what shall be gone, what must stay, and how that is judged.
// It is made at the start (setup/scene_task.h) and never changes; any thread may read.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/assessment/measures/expert_path.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/voxel_ids.h"

namespace bonemill {

// A task divides the scanned bone into zones: what shall go, what may, what must stay. In the order of
// scene.Task.Role.
enum class ZoneRole : uint8_t {
    kTarget,
    kLeewaySides,
    kLeewayBottom,
    kContainerSides,
    kContainerBottom,
    kProtected,
    kContext
};

struct Zone {
    std::string name;
    ZoneRole role = ZoneRole::kContext;
};

using ZoneId = uint8_t;  // 1 + index in the task's list; 0: of no zone
inline constexpr ZoneId kNoZone = 0;

// A protected structure is a material of the scan or a zone; the other id is 0.
struct Structure {
    std::string name;
    MaterialId material = kNoMaterial;
    ZoneId zone = kNoZone;
};

struct PlannedLine {
    Eigen::Vector3d entry_V, tip_V;
    double free;  // m behind the entry; so far the tool may stand out of the bone
};

struct GateRule {
    std::string figure_id, label;  // an empty label: made from the figure's
    double limit = 0;              // in the figure's unit
    bool is_most = true;
};

struct ScoreRule {
    std::string figure_id, label;
    double worst = 0, best = 1, weight = 0;
};

enum class TaskFeedback : uint8_t { kNever, kAfterwards, kLive };

struct JudgedTask {
    std::vector<Zone> zones;
    std::shared_ptr<const VoxelIds> map;               // never null
    std::shared_ptr<const VoxelIds> reference;         // what shall be gone has a zone; null: all targets
    std::shared_ptr<const BoneProperties> properties;  // null: there is no structure of a material
    std::vector<Structure> structures;
    std::optional<Eigen::Vector3d> approach_V;  // into the bone, of length 1
    std::optional<PlannedLine> plan;
    double skeletonised = 1e-3;  // m of bone over a structure

    std::vector<GateRule> gates;
    std::vector<ScoreRule> scores;
    int weights_version = 1;
    std::string weights_hash;  // as Total::weights_hash

    double time_limit_s = 0;  // 0: none
    int most_attempts = 0;    // 0: any number
    bool is_exam = false;
    TaskFeedback feedback = TaskFeedback::kAfterwards;
    std::shared_ptr<const ExpertPath> expert;  // shown during attempts; null: none

    // Shall this voxel be gone?
    bool isIdeal(const Eigen::Vector3i& voxel) const noexcept {
        if (reference) return reference->at(voxel) != kNoZone;
        const ZoneId id = map->at(voxel);
        return id != kNoZone && zones[id - 1].role == ZoneRole::kTarget;
    }
    bool isOf(const Structure& structure, const Eigen::Vector3i& voxel) const noexcept {
        return structure.zone != kNoZone ? map->at(voxel) == structure.zone
                                         : properties->material(voxel) == structure.material;
    }
};

// Turns figures into a judgement, by a task's gates and scales: gates first, then sub-scores, and a total
// only where the teacher gave weights. A gate on a figure that was not measured is not passed. A sub-score on
// one is left out; its weight then counts with a score of 0.
//
// The total of an attempt that passes all gates lies between kPassMark and 1, that of another one below it: q
// is the sub-scores' mean by weight times the share of the target that was reached, and 0 where nothing was
// done; a failed attempt gets q times the square of the share of gates that hold, of what is below kPassMark.
inline constexpr double kPassMark = 0.5;
inline constexpr int kTotalFormula = 2;  // counts the definitions of the total: it is in the weights' hash
Assessment judge(const JudgedTask& task, Figures figures);

}  // namespace bonemill
