// The baseline has penalty contact along the bone's normals, a quaternion coupling, one LU solve and static
// damping (thesis §4.3). It is kept as printed; docs/research/simulate.md lists its warts.
#pragma once

#include "haptic_server/core/contact/penalty_contact.h"
#include "haptic_server/core/coupling/virtual_coupling.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

class Thesis2012Model final : public SpoModel {
  public:
    Thesis2012Model(const PenaltyContactConfig& contact, const CouplingConfig& coupling,
                    const SpoWorld& world, const SpoTool& tool, double dt);

    SpoTraits traits() const noexcept override { return {.mills_voxel_centres = true}; }
    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override;
    void restart() noexcept override {}
    void setAccuracy(const AccuracySettings& settings) noexcept override;
    void setTool(const SpoTool& tool) noexcept override { tool_ = tool.model; }
    void setCoupling(const SpoCoupling& coupling) noexcept override { coupling_ = coupling.thesis; }

  private:
    PenaltyContactConfig contact_;
    CouplingConfig coupling_;
    SpoWorld world_;
    const ToolModel* tool_;
    double dt_;
};

}  // namespace bonemill
