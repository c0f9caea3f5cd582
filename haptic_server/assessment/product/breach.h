// How far the tool has come out of the bone beside a planned line: a pedicle's breach, in the grades of
// Gertzbein and Robbins: A none, B below 2 mm, C below 4, D below 6, E from there on.
//
// The bone is what the scan has at or above the iso-value and what that encloses; a tool counts from `free`
// behind the line's entry on, where its shaft goes through bone, with each of the burr's probes. The depth is
// that of the probe's surface beyond the bone's. The frame is V, the unit m.
//
// add() is for one thread at a time and no tick: some microseconds.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/assessment/product/signed_field.h"
#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// The bone around a line, as it was scanned: what voids it encloses are of it.
class SolidBone {
  public:
    SolidBone(const VoxelVolume& scanned, const PlannedLine& line);

    // m, positive inside, negative beyond the surface.
    double depthAt(const Eigen::Vector3d& p_V) const noexcept { return field_.at(p_V); }
    bool isNear(const Eigen::Vector3d& p_V) const noexcept;

  private:
    Eigen::Vector3d spacing_;
    SignedField field_;
};

class BreachMeter {
  public:
    BreachMeter(std::shared_ptr<const SolidBone> bone, const PlannedLine& line);

    // Another attempt begins.
    void reset() noexcept { last_V_.reset(), depth_ = 0; }

    // The tool was there; it counts if it has come a quarter of a millimetre since.
    void add(const Pose& X_VT, const BurrProbes& burr) noexcept;
    double depth() const noexcept { return depth_; }  // m; 0: no breach

  private:
    bool isShaftInBone(const Pose& X_VT) const noexcept;

    std::shared_ptr<const SolidBone> bone_;
    PlannedLine line_;
    Eigen::Vector3d along_V_;
    std::optional<Eigen::Vector3d> last_V_;
    double depth_ = 0;
};

// 0 to 4 stands for A to E; `depth` in m.
int breachGrade(double depth) noexcept;

// Adds the figures "breach.*".
void addBreachFigures(double depth, Figures& figures);

// Follows the tool through the ticks of an attempt for its breach. It is for one normal thread.
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
