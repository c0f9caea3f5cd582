// All contact laws of other schools, so that the tick has one place to tell them what changes. It allocates
// when it is made; everything else is RT-safe, for the tick thread only.
#pragma once

#include <array>

#include "haptic_server/laws/proxy_3dof.h"

namespace bonemill {

class ComparedLaws {
  public:
    ComparedLaws(const LawConfig& config, const SpoWorld& world, const SpoTool& tool, double dt)
        : proxy_3dof_(config, world, tool, dt) {}

    // Null: the law is none of these.
    SpoModel* of(ContactLaw law) noexcept {
        switch (law) {
            case ContactLaw::kProxy3Dof:
                return &proxy_3dof_;
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

  private:
    std::array<ComparedLaw*, 1> all() noexcept { return {&proxy_3dof_}; }

    Proxy3Dof proxy_3dof_;
};

}  // namespace bonemill
