// All measures of technique of one attempt, from its stream of tick records: the same code beside a live
// session and on what was recorded. docs/reference/assessment.md says what each is, and what it does not say.
//
// Records come in the order of their ticks; lost ones may be missing, which is measured. One normal thread;
// memory is bounded, however long the attempt. Not to be copied or moved.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/meters.h"
#include "haptic_server/assessment/measures/moment_finder.h"
#include "haptic_server/assessment/measures/motion.h"
#include "haptic_server/assessment/measures/strokes.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Tells whether bone lies on the line from the eye to the target, up to `margin` (m) before it. Any thread
// may ask while the tick mills.
bool isHidden(const VoxelVolume& volume, const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_target_W,
              double margin);

// Measures how much is removed where the trainee cannot see it, if the place of the eye is known: the line
// from the eye to what is removed meets bone before it. SI, frame W. One normal thread; memory is fixed.
class Sight {
  public:
    // Tells whether the eye cannot see the burr, whose tool has this number.
    using IsHidden =
        std::function<bool(const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_burr_W, uint32_t tool)>;
    static constexpr double kEvery = 0.02;  // s: of what was removed meanwhile the last place counts for all

    // Without the test nothing is measured.
    explicit Sight(IsHidden is_hidden = {}) : is_hidden_(std::move(is_hidden)) {}

    // The eye is here from the next tick on, until it is somewhere else.
    void setEye(const Eigen::Vector3d& p_eye_W) noexcept {
        if (!p_eye_W.allFinite()) return;
        p_eye_W_ = p_eye_W;
        has_eye_ = true;
    }
    // What was found out with this tick, m³.
    struct Found {
        double seen = 0, unseen = 0;
    };
    Found add(const TickStep& step) {
        removed_ += step.record.removed;
        pending_ += step.record.removed;
        if (!is_hidden_ || step.t() < next_s_ || pending_ <= 0) return {};
        next_s_ = step.t() + kEvery;
        const double removed = std::exchange(pending_, 0);
        if (!has_eye_) return {};
        const Eigen::Vector3d to_eye = p_eye_W_ - step.p_W();
        if (const double norm = to_eye.norm(); norm > 0)
            view_angle_.add(std::acos(std::clamp(to_eye.dot(step.axis_W()) / norm, -1.0, 1.0)) / kDegree,
                            removed);
        const bool is_hidden = is_hidden_(p_eye_W_, step.p_W(), step.record.tool);
        (is_hidden ? unseen_ : seen_) += removed;
        return is_hidden ? Found{0, removed} : Found{removed, 0};
    }
    void append(Figures& figures) const {
        if (!has_eye_) return;
        put(figures, "sight.unseen", 100 * unseen_ / (seen_ + unseen_));
        put(figures, "sight.known", 100 * (seen_ + unseen_) / removed_);
        put(figures, "angle.view", view_angle_.median());
    }

  private:
    IsHidden is_hidden_;
    Eigen::Vector3d p_eye_W_ = Eigen::Vector3d::Zero();
    double next_s_ = 0;
    bool has_eye_ = false;
    double pending_ = 0;                          // m³ not yet judged
    double removed_ = 0, seen_ = 0, unseen_ = 0;  // m³
    Distribution view_angle_;                     // degrees
};

// Sums over one step, SI; temperatures in °C.
struct StepSums {
    double time = 0, contact_time = 0;                              // s
    double impulse = 0, max_force = 0;                              // N s in contact, N
    double way = 0;                                                 // m
    double removed = 0, seen = 0, unseen = 0;                       // m³
    double distance = std::numeric_limits<double>::infinity();      // m, least to a structure
    double temperature = -std::numeric_limits<double>::infinity();  // °C, highest

    void add(const StepSums& other) noexcept {
        time += other.time, contact_time += other.contact_time;
        impulse += other.impulse, max_force = std::max(max_force, other.max_force);
        way += other.way;
        removed += other.removed, seen += other.seen, unseen += other.unseen;
        distance = std::min(distance, other.distance);
        temperature = std::max(temperature, other.temperature);
    }
};

// What happened in steps of a coordinate that only grows (time, or the removed volume), in bounded memory:
// when all rows are taken, two and two become one and steps are twice as wide.
class StepTable {
  public:
    static constexpr size_t kMaxRows = 2048;

    // A row is `step` wide, > 0, at first.
    explicit StepTable(double step) : step_(step) {}

    // `at` >= 0; what is smaller than before belongs to the newest row.
    void add(double at, const StepSums& sums) {
        while (at / step_ >= double(kMaxRows)) widen();
        const size_t row = std::max(size_t(at / step_), rows_.empty() ? 0 : rows_.size() - 1);
        if (row >= rows_.size()) rows_.resize(row + 1);
        rows_[row].add(sums);
    }

    double step() const noexcept { return step_; }
    const std::vector<StepSums>& rows() const noexcept { return rows_; }

  private:
    void widen() {
        for (size_t row = 0; 2 * row < rows_.size(); ++row) {
            StepSums sums = rows_[2 * row];
            if (2 * row + 1 < rows_.size()) sums.add(rows_[2 * row + 1]);
            rows_[row] = sums;
        }
        rows_.resize((rows_.size() + 1) / 2);
        step_ *= 2;
    }

    double step_;
    std::vector<StepSums> rows_;
};

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
