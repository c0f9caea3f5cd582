// The contact laws that a tick can choose from. Each is handed in as a way to make its model, so that the
// tick knows none of them by name.
//
// Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "common/base/assert.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/equilibrium/spo_model.h"

namespace bonemill {

// A model is made from this, and keeps of it the references in `world` and the tools' models.
struct SpoParts {
    const PenaltyContactConfig& contact;
    const CouplingConfig& coupling;
    const GradientConfig& gradient;
    SpoWorld world;
    std::span<const SpoTool> tools;  // all that setTool() may be called with
    const SpoTool& tool;             // one of them: in use at first
    double dt;                       // s
};

struct SpoLaw {
    ContactLaw law;
    std::unique_ptr<SpoModel> (*make)(const SpoParts& parts);
};

// Returns the gradient law and, as the baseline, the thesis'.
std::span<const SpoLaw> ownLaws() noexcept;

class SpoModels {
  public:
    // Makes a model of each of `laws`, at least one.
    SpoModels(std::span<const SpoLaw> laws, const SpoParts& parts) {
        for (const SpoLaw& law : laws) models_.push_back({law.law, law.make(parts)});
        BONEMILL_ASSERT(!models_.empty());
    }

    // `law` is one of those handed in; of another one the first takes the place.
    SpoModel& of(ContactLaw law) const noexcept {
        for (const Entry& entry : models_)
            if (entry.law == law) return *entry.model;
        BONEMILL_ASSERT(false);
        return *models_.front().model;
    }
    // Tells every model, whichever is in force: a call of tell(SpoModel&) for each.
    template <class Tell>
    void forEach(Tell tell) const noexcept {
        for (const Entry& entry : models_) tell(*entry.model);
    }
    size_t mostCandidates() const noexcept {
        size_t most = 0;
        forEach([&](SpoModel& model) { most = std::max(most, model.mostCandidates()); });
        return most;
    }

  private:
    struct Entry {
        ContactLaw law;
        std::unique_ptr<SpoModel> model;
    };
    std::vector<Entry> models_;
};

}  // namespace bonemill
