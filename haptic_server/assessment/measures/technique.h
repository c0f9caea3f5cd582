// All measures of technique of one attempt, from its stream of tick records: the same code beside a live
// session and on what was recorded. docs/teach/assessment.md says what each is, and what it does not say.
//
// Records come in the order of their ticks; lost ones may be missing, which is measured. One normal thread;
// memory is bounded, however long the attempt. Not to be copied or moved.
#pragma once

#include <optional>

#include "haptic_server/assessment/measures/force_meter.h"
#include "haptic_server/assessment/measures/heat_meter.h"
#include "haptic_server/assessment/measures/moment_finder.h"
#include "haptic_server/assessment/measures/removal_meter.h"
#include "haptic_server/assessment/measures/sight.h"
#include "haptic_server/assessment/measures/steadiness.h"
#include "haptic_server/assessment/measures/step_table.h"
#include "haptic_server/assessment/measures/strokes.h"
#include "haptic_server/assessment/measures/structure_meter.h"
#include "haptic_server/assessment/measures/time_meter.h"

namespace bonemill {

class Technique {
  public:
    static constexpr double kLongestTick = 0.1;  // s between two records: what is more was lost
    static constexpr int kBuckets = 5;           // of equal removed volume

    explicit Technique(const TechniqueScene& scene, Sight::IsHidden is_hidden = {});
    Technique(const Technique&) = delete;
    Technique& operator=(const Technique&) = delete;

    void add(const TickRecord& record);
    // The trainee's eye is here from the next record on.
    void setEye(const Eigen::Vector3d& p_eye_W) noexcept { sight_.setEye(p_eye_W); }
    // No record comes any more. Only then the figures are whole.
    void finish();

    bool isEmpty() const noexcept { return !last_s_; }
    double beginS() const noexcept { return begin_s_; }  // of the session
    const StructureMeter& structures() const noexcept { return structures_; }
    const TurnStrokes& strokes() const noexcept { return turns_; }
    Figures figures() const;
    // By seconds of the attempt (more than one each, when it was long), and by buckets of equal removed
    // volume.
    std::vector<SeriesTable> series() const;
    std::vector<Moment> moments() const { return moments_.inOrder(); }
    // The attempt's figures, series and moments; gates and scores are the task's.
    Assessment assessment() const { return {{}, figures(), {}, {}, series(), moments()}; }

  private:
    void addMotion(const MotionSample& sample);
    std::vector<StepSums> buckets() const;

    TechniqueScene scene_;
    std::optional<double> last_s_;
    double begin_s_ = 0;
    Motion motion_;
    TimeMeter time_;
    ForceMeter force_;
    RemovalMeter removal_;
    StructureMeter structures_;
    HeatMeter heat_;
    Steadiness steadiness_;
    Sight sight_;
    TurnStrokes turns_;
    ContactBouts bouts_;
    MinimumStrokes minima_;
    MomentFinder moments_;
    StepTable seconds_{1}, volumes_{1e-12};  // s, m³
};

}  // namespace bonemill
