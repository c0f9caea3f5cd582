#include "haptic_server/laws/all_laws.h"

#include "haptic_server/laws/constraint_law.h"
#include "haptic_server/laws/penalty_sdf.h"
#include "haptic_server/laws/proxy_3dof.h"
#include "haptic_server/laws/vps.h"

namespace bonemill {
namespace {

LawConfig configOf(const SpoParts& parts) {
    return {parts.contact, parts.coupling, parts.gradient.coupling};
}

template <class Law>
std::unique_ptr<SpoModel> makeLaw(const SpoParts& parts) {
    return std::make_unique<Law>(configOf(parts), parts.world, parts.tool, parts.dt);
}

std::unique_ptr<SpoModel> makeVps(const SpoParts& parts) {
    return std::make_unique<Vps>(configOf(parts), parts.world, parts.tools, parts.tool, parts.dt);
}

constexpr SpoLaw kOtherLaws[] = {{ContactLaw::kProxy3Dof, makeLaw<Proxy3Dof>},
                                 {ContactLaw::kVps, makeVps},
                                 {ContactLaw::kPenaltySdf, makeLaw<PenaltySdf>},
                                 {ContactLaw::kConstraint, makeLaw<ConstraintLaw>}};

}  // namespace

std::span<const SpoLaw> allLaws() {
    static const std::vector<SpoLaw> kAll = [] {
        std::vector<SpoLaw> all(ownLaws().begin(), ownLaws().end());
        all.insert(all.end(), std::begin(kOtherLaws), std::end(kOtherLaws));
        return all;
    }();
    return kAll;
}

}  // namespace bonemill
