// Measures how much is removed where the trainee cannot see it, if the place of the eye is known: the line
// from the eye to what is removed meets bone before it. SI, frame W. One normal thread; memory is fixed.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/tick_step.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Tells whether bone lies on the line from the eye to the target, up to `margin` (m) before it. Any thread
// may ask while the tick mills.
bool isHidden(const VoxelVolume& volume, const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_target_W,
              double margin);

class Sight {
  public:
    // Tells whether the eye cannot see the burr, whose tool has this number.
    using IsHidden =
        std::function<bool(const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_burr_W, uint32_t tool)>;
    static constexpr double kEvery = 0.02;  // s: of what was removed meanwhile the last place counts for all

    // Without the test nothing is measured.
    explicit Sight(IsHidden is_hidden = {}) : is_hidden_(std::move(is_hidden)) {}

    // The eye is here from the next tick on, until it is somewhere else.
    void setEye(const Eigen::Vector3d& p_eye_W) noexcept;
    // What was found out with this tick, m³.
    struct Found {
        double seen = 0, unseen = 0;
    };
    Found add(const TickStep& step);
    void append(Figures& figures) const;

  private:
    IsHidden is_hidden_;
    Eigen::Vector3d p_eye_W_ = Eigen::Vector3d::Zero();
    double next_s_ = 0;
    bool has_eye_ = false;
    double pending_ = 0;                          // m³ not yet judged
    double removed_ = 0, seen_ = 0, unseen_ = 0;  // m³
    Distribution view_angle_;                     // degrees
};

}  // namespace bonemill
