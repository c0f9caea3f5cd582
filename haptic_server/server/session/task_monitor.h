// How the scene's task stands while it is done, and what an attempt at it came to: what is gone of each zone
// is counted from the leaves that changed, and when an attempt has ended a thread of its own measures and
// judges the bone that it left.
//
// All members belong to the publisher thread or to whoever has joined it, but for showsZones().
#pragma once

#include <atomic>
#include <future>
#include <optional>
#include <string>

#include "haptic_server/assessment/product/product.h"
#include "haptic_server/assessment/product/zone_tally.h"
#include "haptic_server/core/bone/bone_history.h"
#include "proto/topics.pb.h"

namespace bonemill {

class TaskMonitor {
  public:
    struct Result {
        Assessment assessment;
        DeviationPicture picture;
        std::string problem;  // why there is no assessment; else empty
    };

    // `task` is null in a scene without one: then nothing is watched. References must outlive this object.
    TaskMonitor(std::shared_ptr<const JudgedTask> task, const BoneModel& bone, BoneHistory& history);
    // Waits for the judgement under way: it works on this object, whoever else waits for it.
    ~TaskMonitor();
    TaskMonitor(const TaskMonitor&) = delete;
    TaskMonitor& operator=(const TaskMonitor&) = delete;

    const JudgedTask* task() const noexcept { return task_.get(); }
    // Are viewers to see the zones on the bone now? For any thread.
    bool showsZones() const noexcept { return shows_zones_.load(std::memory_order_relaxed); }

    // Some times per second: takes up what changed, for some milliseconds, and a result that is there.
    void round();
    void beginAttempt();
    // The bone is judged after the one of the attempt before; nobody waits for that here. What
    // else was measured of the attempt goes in with it: gates and scores may ask for it. Any thread may wait
    // for what it returns, which is nothing without a task.
    std::shared_future<Result> endAttempt(std::shared_ptr<const BoneSnapshot> bone,
                                          std::optional<double> breach, Figures technique);
    // Waits for the judgement under way, if there is one, and takes it up.
    void finish();

    // Says what trainees may know now.
    void describe(bool is_running, double time_s, topics::Status& status) const;

  private:
    Figures runningFigures() const;
    void describeZones(topics::TaskState& state) const;

    std::shared_ptr<const JudgedTask> task_;
    const BoneModel& bone_;
    BoneHistory& history_;
    ProductCounts scanned_counts_;       // what was bone, and nothing gone
    std::optional<RunningTally> tally_;  // with a task
    int64_t next_update_ns_ = 0;
    std::shared_future<Result> judging_;
    std::optional<Assessment> last_;  // of the attempt before
    std::atomic<bool> shows_zones_;   // relaxed: the mesher sees it at some later round
};

}  // namespace bonemill
