// The tool's contacts are merged into a few, for what is evaluated again and again in a solve. Units are SI,
// axes V, torques about the tool point. It is RT-safe, for the tick thread only.
#pragma once

#include <array>
#include <span>

#include "haptic_server/core/effects/haptic_effect.h"

namespace bonemill {

struct ContactGroup {
    double force = 0;                                      // N: Σ F
    Eigen::Vector3d r = Eigen::Vector3d::Zero();           // from the tool point, weighted by F
    Eigen::Matrix3d tangential = Eigen::Matrix3d::Zero();  // I − n nᵀ, weighted by F
};

// One group for each of 4 × 4 × 4 boxes that hold contacts; together the boxes just hold all, along the
// tool's axes. Forces, and what the contacts do to a translation, are kept exactly; of turns the part that
// comes from the places' spread inside a box, about 1/16, is lost.
class ContactGroups {
  public:
    static constexpr int kBoxesPerAxis = 4;
    static constexpr size_t kMax = kBoxesPerAxis * kBoxesPerAxis * kBoxesPerAxis;

    // Gathers the last tick's contacts: one on the burr with burr_share of its force, any other with all of
    // it. What has no force is left out.
    void gather(const EffectTick& tick, double burr_share) noexcept;
    void clear() noexcept { count_ = 0, force_ = 0; }

    std::span<const ContactGroup> groups() const noexcept { return {groups_.data(), count_}; }
    double force() const noexcept { return force_; }  // N, of all

  private:
    std::array<ContactGroup, kMax> groups_;
    size_t count_ = 0;
    double force_ = 0;
};

}  // namespace bonemill
