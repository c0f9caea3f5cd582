// The baseline has penalty contact along the bone's normals, a quaternion coupling, one LU solve and static
// damping (thesis §4.3). It is kept as printed; docs/explanation/laws.md lists its warts.
#pragma once

#include "haptic_server/core/contact/penalty_contact.h"
#include "haptic_server/core/coupling/thesis_2012_coupling.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

class Thesis2012Model final : public SpoModel {
  public:
    Thesis2012Model(const PenaltyContactConfig& contact, const CouplingConfig& coupling,
                    const SpoWorld& world, const SpoTool& tool, double dt)
        : contact_(contact), coupling_(coupling), world_(world), tool_(tool.model), dt_(dt) {}

    SpoTraits traits() const noexcept override { return {.mills_voxel_centres = true}; }
    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override {
        const ContactWrench contact =
            penaltyContact(contact_, world_.volume, world_.lattice, world_.shell, tool_->grid(), X_VT);
        const EnergyTerm pull{.wrench = couplingWrench(coupling_, X_VT, X_VT_device),
                              .stiffness = -couplingDerivative(coupling_, X_VT, X_VT_device)};
        SpoStep step;
        step.X_VT = quasiStaticStep(contact, pull, coupling_, X_VT, dt_, step);
        step.wrench_hand_V = -couplingWrench(coupling_, step.X_VT, X_VT_device);
        return step;
    }
    void restart() noexcept override {}
    void setAccuracy(const AccuracySettings& settings) noexcept override {
        contact_.shell_level = levelOf(world_.shell, settings);
    }
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
