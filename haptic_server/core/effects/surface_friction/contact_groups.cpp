#include "haptic_server/core/effects/surface_friction/contact_groups.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMinBox = 1e-9;  // m: of contacts at one place

}  // namespace

void ContactGroups::gather(const EffectTick& tick, double burr_share) noexcept {
    clear();
    const auto shareOf = [&](size_t n) { return tick.is_on_burr[n] ? burr_share : 1.0; };
    const Eigen::Quaterniond R_TV = tick.X_VT_start.rotation.conjugate();
    Eigen::AlignedBox3d all;
    for (size_t n = 0; n < tick.contacts.size(); ++n)
        if (shareOf(n) > 0) all.extend(R_TV * tick.contacts[n].r_V.cast<double>());
    if (all.isEmpty()) return;

    std::array<ContactGroup, kMax> boxes{};
    const Vector3d per_box = kBoxesPerAxis / all.sizes().array().max(kMinBox);
    for (size_t n = 0; n < tick.contacts.size(); ++n) {
        const SurfaceContact& contact = tick.contacts[n];
        const double force = shareOf(n) * double(contact.force);
        if (!(force > 0)) continue;
        const Vector3d r = contact.r_V.cast<double>(), normal = contact.push_V.cast<double>();
        const Vector3d place = (R_TV * r - all.min()).cwiseProduct(per_box);
        const Eigen::Array3i box = place.array().floor().cast<int>().max(0).min(kBoxesPerAxis - 1);
        ContactGroup& group = boxes[size_t(box.x() + kBoxesPerAxis * (box.y() + kBoxesPerAxis * box.z()))];
        group.force += force;
        group.r += force * r;
        group.tangential += force * (Matrix3d::Identity() - normal * normal.transpose());
    }
    for (const ContactGroup& box : boxes) {
        if (!(box.force > 0)) continue;
        groups_[count_++] = {box.force, box.r / box.force, box.tangential / box.force};
        force_ += box.force;
    }
}

}  // namespace bonemill
