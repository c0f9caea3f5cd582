// Follows an attempt at a scene's task from tick to tick, judges it in the end, and writes results and
// report, as a live session does. It is for one normal thread; writing waits for the disk.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/config/scene_file.h"
#include "haptic_server/assessment/measures/technique.h"
#include "haptic_server/assessment/product/product.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

class TaskRun {
  public:
    // In a scene without a task it does nothing, unless the technique is `wanted`. `simulation` must outlive
    // it.
    TaskRun(const scene::Scene& scene, const SceneSetup& simulation, bool wanted = false);

    void add(const TickRecord& record);
    // The trainee's eye is here from the next record on.
    void setEye(const Eigen::Vector3d& p_eye_W);
    struct Result {
        Assessment assessment;
        DeviationPicture picture;
        double begin_s = 0;  // of the first record
    };
    // No record comes any more; there is a task, or the technique was wanted.
    Result judgeBone(const VoxelVolume& scanned, const VoxelVolume& now);

  private:
    std::shared_ptr<const JudgedTask> task_;
    std::optional<BreachMonitor> breach_;
    std::unique_ptr<Technique> technique_;
};

// For programs: {"passed", "gates": [...], "sub_scores": [...], "total", "figures": {id: value}}.
nlohmann::json assessmentJson(const Assessment& assessment);

// Writes a file. Throws UserError when that fails.
void writeBytes(const std::string& path, const std::string& bytes);

struct AssessmentTarget {
    std::string folder;
    std::string pseudonym;
    double duration_s = 0;
    uint32_t number = 1;
    int64_t start_unix_ns = 0;  // 0: now
    std::string journal = {};   // the recording's file name; empty: none
};

// Returns the files' name without endings. What could not be written is noted in `files`.
std::string writeAssessment(const AssessmentTarget& target, const LoadedScene& loaded,
                            const TaskRun::Result& result, FinalFiles& files);

}  // namespace bonemill
