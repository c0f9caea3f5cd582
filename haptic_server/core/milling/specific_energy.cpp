#include "haptic_server/core/milling/specific_energy.h"

#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"

namespace bonemill {

SpecificEnergy::SpecificEnergy(const SpecificEnergyConfig& config,
                               std::shared_ptr<const BoneProperties> properties, Density iso)
    : properties_(std::move(properties)),
      reference_(config.reference),
      iso_(iso),
      materials_(config.materials) {
    for (int density = 0; density <= kMaxDensity + 1; density += kStep) {
        const double bone = std::max(density, int(iso));
        of_density_.push_back(reference_ * pinned::pow(bone / config.reference_density, config.exponent));
    }
}

double SpecificEnergy::ofScannedCell(const Eigen::Vector3i& cell) const noexcept {
    Density densest = 0;
    MaterialId material = kNoMaterial;
    properties_->forEachCorner(cell, [&](Density density, MaterialId of_corner) {
        if (density <= densest) return;
        densest = density;
        material = of_corner;
    });
    if (densest < iso_) return reference_;
    const double own = material < materials_.size() ? materials_[material].specific_energy : 0;
    return own > 0 ? own : ofDensity(densest);
}

double SpecificEnergy::ofDensity(Density density) const noexcept {
    const size_t below = density / kStep;
    const double share = double(density % kStep) / kStep;
    return of_density_[below] + share * (of_density_[below + 1] - of_density_[below]);
}

}  // namespace bonemill
