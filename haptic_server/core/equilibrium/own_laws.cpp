#include "haptic_server/core/equilibrium/gradient_model.h"
#include "haptic_server/core/equilibrium/spo_models.h"
#include "haptic_server/core/equilibrium/thesis_2012_model.h"

namespace bonemill {
namespace {

constexpr SpoLaw kOwnLaws[] = {
    {ContactLaw::kGradient,
     [](const SpoParts& parts) -> std::unique_ptr<SpoModel> {
         return std::make_unique<GradientModel>(parts.gradient, parts.world, parts.tool, parts.dt);
     }},
    {ContactLaw::kThesis2012,
     [](const SpoParts& parts) -> std::unique_ptr<SpoModel> {
         return std::make_unique<Thesis2012Model>(parts.contact, parts.coupling, parts.world, parts.tool,
                                                  parts.dt);
     }},
};

}  // namespace

std::span<const SpoLaw> ownLaws() noexcept {
    return kOwnLaws;
}

}  // namespace bonemill
