// A run of a scene whose ticks come one by one, each when it is asked for: what all such runs know, whoever
// has the hand. SI, frame W. One normal thread at a time.
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/config/scene_file.h"
#include "common/geometry/pose.h"
#include "haptic_server/assessment/product/zone_tally.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/lab/simulate/task_run.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {

// The hand for one tick: where it holds the tool, and Button bits.
struct HandStep {
    Pose X_WT;
    uint32_t buttons = 0;
    std::optional<double> t_s = {};  // without: a period after the tick before
};

// How much of a zone has been milled away, in m³.
struct ZoneProgress {
    std::string name;
    ZoneRole role;
    double bone, removed;
};
struct TaskProgress {
    std::vector<ZoneProgress> zones;
    double ideal = 0, ideal_removed = 0;  // m³: what shall be gone, and what of it is
    double removed = 0;                   // m³, anywhere
    Eigen::Vector3d p_ideal_W;            // m: the middle of the box around what shall be gone
};

// The bone's surface, as triangles counter-clockwise seen from outside.
struct RunSurface {
    std::vector<Eigen::Vector3d> vertices_W;  // m
    std::vector<std::array<uint32_t, 3>> triangles;
};

class SteppedRun {
  public:
    virtual ~SteppedRun() = default;
    SteppedRun(const SteppedRun&) = delete;
    SteppedRun& operator=(const SteppedRun&) = delete;

    // Why no tick can take this hand, a sentence; empty if one can. `before` is the time of the tick before.
    std::string problemOf(const HandStep& hand, std::optional<double> before) const;
    std::string problemOf(const HandStep& hand) const;  // as the next one
    // Runs one tick with this hand. The record is good until the next call. Throws UserError if there is a
    // problem with it.
    const TickRecord& step(const HandStep& hand);
    // Of the last tick; before the first one all is 0.
    const TickRecord& record() const noexcept { return record_; }
    uint64_t ticks() const noexcept { return ticks_; }

    // What `simulate` would call state_hash after these ticks.
    uint64_t stateHash() const;
    const RecordedEffects& recorded() const noexcept { return recorded_; }
    const LoadedScene& loaded() const noexcept { return loaded_; }
    const SceneSetup& setup() const noexcept { return setup_; }
    const BoneModel& bone() const noexcept { return *setup_.bone; }
    const VoxelVolume& scanned() const noexcept { return scanned_; }
    std::vector<std::string> toolNames() const;

    // The voxels that may have changed since the last call; at first all.
    IndexBox takeChanged() noexcept { return std::exchange(changed_, {}); }

    // Copies the densities of this box of voxels to their places in `all`, where the whole volume lies x
    // fastest.
    void copyVoxels(const IndexBox& box, std::span<Density> all) const;
    RunSurface surface() const;

    virtual size_t tool() const = 0;
    // From the next tick on.
    virtual void chooseTool(size_t tool) = 0;

    // How far the task is: looks at what changed since the last call. Throws UserError without a task.
    const TaskProgress& progress();
    // An attempt begins with the next tick: what was done before counts for the bone, and not for technique.
    void beginAttempt();
    // Judges the attempt, from the first tick or beginAttempt() on, as a session judges one; the same again
    // without a tick in between. It ends the attempt. Throws UserError without a task.
    const nlohmann::json& judge();

  protected:
    explicit SteppedRun(const LoadedScene& loaded);
    // As scanned, nothing done: for who begins anew.
    void beginAnew();
    SceneSetup& ownSetup() noexcept { return setup_; }
    const TickRecord& note(const TickRecord& record);
    bool isJudged() const noexcept { return judged_ticks_.has_value(); }
    void noteAllChanged() noexcept;

  private:
    virtual const TickRecord& tick(const HandStep& hand) = 0;
    void requireTask() const;
    void beginWatching();

    LoadedScene loaded_;
    SceneSetup setup_;
    RecordedEffects recorded_;
    VoxelVolume scanned_;
    StateHash hash_;
    std::unique_ptr<TaskRun> task_;
    std::optional<ProductCounts> counts_;  // of the scanned bone; from the first progress() on
    std::optional<RunningTally> tally_;
    TaskProgress progress_;
    nlohmann::json judged_;
    std::optional<uint64_t> judged_ticks_;
    IndexBox changed_;
    TickRecord record_{};
    uint64_t ticks_ = 0;
};

}  // namespace bonemill
