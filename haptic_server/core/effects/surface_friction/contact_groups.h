// The tool's contacts are merged into a few, for what is evaluated again and again in a solve. Units are SI,
// axes V, torques about the tool point. It is RT-safe, for the tick thread only.
#pragma once

#include <Eigen/Geometry>
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
    void gather(const EffectTick& tick, double burr_share) noexcept {
        clear();
        const auto shareOf = [&](size_t n) { return tick.is_on_burr[n] ? burr_share : 1.0; };
        const Eigen::Quaterniond R_TV = tick.X_VT_start.rotation.conjugate();
        Eigen::AlignedBox3d all;
        for (size_t n = 0; n < tick.contacts.size(); ++n)
            if (shareOf(n) > 0) all.extend(R_TV * tick.contacts[n].r_V.cast<double>());
        if (all.isEmpty()) return;

        std::array<ContactGroup, kMax> boxes{};
        const Eigen::Vector3d per_box = kBoxesPerAxis / all.sizes().array().max(kMinBox);
        for (size_t n = 0; n < tick.contacts.size(); ++n) {
            const SurfaceContact& contact = tick.contacts[n];
            const double force = shareOf(n) * double(contact.force);
            if (!(force > 0)) continue;
            const Eigen::Vector3d r = contact.r_V.cast<double>(), normal = contact.push_V.cast<double>();
            const Eigen::Vector3d place = (R_TV * r - all.min()).cwiseProduct(per_box);
            const Eigen::Array3i box = place.array().floor().cast<int>().max(0).min(kBoxesPerAxis - 1);
            ContactGroup& group =
                boxes[size_t(box.x() + kBoxesPerAxis * (box.y() + kBoxesPerAxis * box.z()))];
            group.force += force;
            group.r += force * r;
            group.tangential += force * (Eigen::Matrix3d::Identity() - normal * normal.transpose());
        }
        for (const ContactGroup& box : boxes) {
            if (!(box.force > 0)) continue;
            groups_[count_++] = {box.force, box.r / box.force, box.tangential / box.force};
            force_ += box.force;
        }
    }
    void clear() noexcept { count_ = 0, force_ = 0; }

    std::span<const ContactGroup> groups() const noexcept { return {groups_.data(), count_}; }
    double force() const noexcept { return force_; }  // N, of all

  private:
    static constexpr double kMinBox = 1e-9;  // m: of contacts at one place

    std::array<ContactGroup, kMax> groups_;
    size_t count_ = 0;
    double force_ = 0;
};

}  // namespace bonemill
