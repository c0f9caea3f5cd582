// Says how much energy a volume of bone takes to be cut: by the density that it had in the scan, or by its
// material. u = u_ref (ρ/ρ_ref)^exponent (ALGORITHMS: 1.5 .. 2), ρ above the window's lower end. Construction
// allocates; ofCell() is RT-safe, for one thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "common/math/pinned_math.h"
#include "haptic_server/core/milling/cell_memory.h"
#include "haptic_server/core/volume/bone_properties.h"

namespace bonemill {

struct SpecificEnergyConfig {
    double reference;          // u_ref, J/m³
    double reference_density;  // ρ_ref, counts
    double exponent;
    MaterialTable materials;  // those with a specific_energy of their own have it at any density
};

class SpecificEnergy {
  public:
    // Without properties all bone is as the reference. Below `iso` there is no bone: what was laid down there
    // is as the reference, too.
    SpecificEnergy(const SpecificEnergyConfig& config, std::shared_ptr<const BoneProperties> properties,
                   Density iso)
        : properties_(std::move(properties)),
          reference_(config.reference),
          iso_(iso),
          materials_(config.materials) {
        for (int density = 0; density <= kMaxDensity + 1; density += kStep) {
            const double bone = std::max(density, int(iso));
            of_density_.push_back(reference_ * pinned::pow(bone / config.reference_density, config.exponent));
        }
    }

    // The densest of the cell's corners decides; the unit is J/m³.
    double ofCell(const Eigen::Vector3i& cell) noexcept {
        if (!properties_) return reference_;
        const double* const known = known_.find(cell);
        return known ? *known : known_.remember(cell, ofScannedCell(cell));
    }

  private:
    static constexpr int kStep = 256;  // counts between entries of the table
    double ofScannedCell(const Eigen::Vector3i& cell) const noexcept {
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
    double ofDensity(Density density) const noexcept {
        const size_t below = density / kStep;
        const double share = double(density % kStep) / kStep;
        return of_density_[below] + share * (of_density_[below + 1] - of_density_[below]);
    }

    std::shared_ptr<const BoneProperties> properties_;
    double reference_;
    Density iso_;
    MaterialTable materials_;
    std::vector<double> of_density_;  // at multiples of kStep
    CellMemory<double> known_;
};

}  // namespace bonemill
