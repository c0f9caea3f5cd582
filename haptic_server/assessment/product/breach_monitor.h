// Follows the tool through the ticks of an attempt for its breach (breach.h). It is for one normal thread.
#pragma once

#include <utility>
#include <vector>

#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

class BreachMonitor {
  public:
    // `burrs` are the tools' in the scene's order. The bone is copied.
    BreachMonitor(const VoxelVolume& scanned, const PlannedLine& line, std::vector<BurrProbes> burrs)
        : X_VW_(scanned.geometry().X_WV.inverse()),
          meter_(std::make_shared<const SolidBone>(scanned, line), line),
          burrs_(std::move(burrs)) {}

    void reset() noexcept { meter_.reset(); }
    void add(const TickRecord& record) noexcept {
        if (record.tool >= burrs_.size()) return;
        const double(&p)[3] = record.p_WT;
        const double(&q)[4] = record.q_WT;
        const Pose X_WT{{p[0], p[1], p[2]}, Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
        meter_.add(X_VW_ * X_WT, burrs_[record.tool]);
    }
    double depth() const noexcept { return meter_.depth(); }  // m

  private:
    Pose X_VW_;
    BreachMeter meter_;
    std::vector<BurrProbes> burrs_;
};

}  // namespace bonemill
