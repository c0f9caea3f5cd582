#include "haptic_server/milling/specific_energy.h"

#include <algorithm>
#include <cmath>

namespace bonemill {

SpecificEnergy::SpecificEnergy(const SpecificEnergyConfig& config,
                               std::shared_ptr<const BoneProperties> properties, Density iso)
    : properties_(std::move(properties)),
      reference_(config.reference),
      iso_(iso),
      materials_(config.materials) {
    for (int density = 0; density <= kMaxDensity + 1; density += kStep) {
        const double bone = std::max(density, int(iso));
        of_density_.push_back(reference_ * std::pow(bone / config.reference_density, config.exponent));
    }
}

double SpecificEnergy::ofScannedCell(const Eigen::Vector3i& cell) const noexcept {
    Density densest = 0;
    Eigen::Vector3i voxel = cell;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i v = cell + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const Density density = properties_->original(v);
        if (density <= densest) continue;
        densest = density;
        voxel = v;
    }
    if (densest < iso_) return reference_;
    const MaterialId material = properties_->material(voxel);
    const double own = material < materials_.size() ? materials_[material].specific_energy : 0;
    return own > 0 ? own : ofDensity(densest);
}

double SpecificEnergy::ofDensity(Density density) const noexcept {
    const size_t below = density / kStep;
    const double share = double(density % kStep) / kStep;
    return of_density_[below] + share * (of_density_[below + 1] - of_density_[below]);
}

}  // namespace bonemill
