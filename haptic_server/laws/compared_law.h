// The laws of other schools have this in common, beside which our own is judged (docs/explanation/laws.md):
// the spring between hand and tool, which all of them share with the gradient law so that only contact
// differs, and what they are told while ticks go on.
//
// The spring is Barbič and James' static virtual coupling that saturates; the relaxing spring and the damping
// of the gradient law are not part of it. All of it is RT-safe but for construction, for the tick thread
// only.
#pragma once

#include <algorithm>
#include <limits>

#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/coupling/energy_coupling.h"
#include "haptic_server/core/coupling/thesis_2012_coupling.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

struct LawConfig {
    PenaltyContactConfig points;  // vps and penalty_sdf: N/m per point, and vps' limit on their number
    CouplingConfig steps;         // of this the speed limits and the static damping
    EnergyCouplingConfig coupling;
};

class ComparedLaw : public SpoModel {
  public:
    // The coupling never pulls with more than `most_carried`, N.
    ComparedLaw(const LawConfig& config, const SpoWorld& world, const SpoTool& tool, double dt,
                double most_carried = std::numeric_limits<double>::infinity())
        : config_(config),
          world_(world),
          dt_(dt),
          most_carried_(most_carried),
          tool_(tool),
          field_(&tool.model->field(settings_)) {
        saturate();
    }

    void restart() noexcept override { way_.forget(); }
    void setAccuracy(const AccuracySettings& settings) noexcept override {
        settings_ = settings;
        level_ = levelOf(world_.shell, settings);
        field_ = &tool_.model->field(settings_);
    }
    void setTool(const SpoTool& tool) noexcept override {
        tool_ = tool;
        field_ = &tool_.model->field(settings_);
        saturate();
    }
    void setCoupling(const SpoCoupling& coupling) noexcept override {
        config_.coupling = coupling.energy;
        most_pull_ = coupling.most_pull;
        saturate();
    }
    void setCutting(bool is_cutting) noexcept override { is_cutting_ = is_cutting; }

  protected:
    // A rigid burr that never entered the bone would cut nothing: while it cuts, it may be so deep in it, m.
    double bite() const noexcept { return is_cutting_ ? kBite * world_.volume.spacing().minCoeff() : 0; }
    // Ends a tick with the tool at this pose: says what the hand gets.
    void feel(SpoStep& step, const Pose& X_VT, const Pose& X_VT_device) noexcept {
        step.X_VT = X_VT;
        step.wrench_hand_V = couplingWrenchOnDevice(coupling_, X_VT, X_VT_device, way_);
        way_.remember(X_VT_device.rotation * X_VT.rotation.conjugate());
    }

    const LawConfig& config() const noexcept { return config_; }
    const SpoWorld& world() const noexcept { return world_; }
    const ToolField& field() const noexcept { return *field_; }
    const EnergyCoupling& coupling() const noexcept { return coupling_; }
    const ContinuousRotation& way() const noexcept { return way_; }
    int level() const noexcept { return level_; }
    int iterations() const noexcept { return settings_.iterations; }
    double dt() const noexcept { return dt_; }

  private:
    static constexpr double kBite = 0.1;  // voxels

    void saturate() noexcept {
        static_cast<EnergyCouplingConfig&>(coupling_) = config_.coupling;
        coupling_.saturation_force = std::min({tool_.saturation_force, most_pull_, most_carried_});
    }

    LawConfig config_;
    SpoWorld world_;
    double dt_;
    double most_carried_;  // N
    AccuracySettings settings_;
    SpoTool tool_;
    const ToolField* field_;
    EnergyCoupling coupling_;
    double most_pull_ = std::numeric_limits<double>::infinity();  // N
    ContinuousRotation way_;
    int level_ = 0;
    bool is_cutting_ = false;
};

}  // namespace bonemill
