// All contact laws of other schools, so that the tick has one place to tell them what changes. It allocates
// when it is made; everything else is RT-safe, for the tick thread only.
#pragma once

#include <array>

#include "haptic_server/laws/constraint_law.h"
#include "haptic_server/laws/penalty_sdf.h"
#include "haptic_server/laws/proxy_3dof.h"
#include "haptic_server/laws/vps.h"

namespace bonemill {

class ComparedLaws {
  public:
    // `tool` is the one in use at first, one of `tools`.
    ComparedLaws(const LawConfig& config, const SpoWorld& world, std::span<const SpoTool> tools,
                 const SpoTool& tool, double dt)
        : proxy_3dof_(config, world, tool, dt),
          vps_(config, world, tools, tool, dt),
          penalty_sdf_(config, world, tool, dt),
          constraint_(config, world, tool, dt) {}

    // Null: the law is none of these.
    ComparedLaw* of(ContactLaw law) noexcept {
        switch (law) {
            case ContactLaw::kProxy3Dof:
                return &proxy_3dof_;
            case ContactLaw::kVps:
                return &vps_;
            case ContactLaw::kPenaltySdf:
                return &penalty_sdf_;
            case ContactLaw::kConstraint:
                return &constraint_;
            default:
                return nullptr;
        }
    }
    void setTool(const SpoTool& tool) noexcept {
        for (ComparedLaw* law : all()) law->setTool(tool);
    }
    // Takes effect with the next advance(), whose coupling pulls with `most_pull` (N) at most.
    void setCoupling(const EnergyCouplingConfig& coupling, double most_pull) noexcept {
        for (ComparedLaw* law : all()) law->setCoupling(coupling, most_pull);
    }
    // The burr in use removes bone from the next advance() on, or no longer does.
    void setCutting(bool is_cutting) noexcept {
        for (ComparedLaw* law : all()) law->setCutting(is_cutting);
    }

  private:
    std::array<ComparedLaw*, 4> all() noexcept { return {&proxy_3dof_, &vps_, &penalty_sdf_, &constraint_}; }

    Proxy3Dof proxy_3dof_;
    Vps vps_;
    PenaltySdf penalty_sdf_;
    ConstraintLaw constraint_;
};

}  // namespace bonemill
