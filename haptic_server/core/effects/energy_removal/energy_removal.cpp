#include "haptic_server/core/effects/energy_removal/energy_removal.h"

#include <algorithm>
#include <cmath>

#include "common/math/pinned_math.h"
#include "haptic_server/core/contact/into_tool.h"
#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/make_effects.h"

namespace bonemill {

EnergyRemoval::EnergyRemoval(const EnergyRemovalConfig& config, const EffectConfigs& all,
                             const BoneModel& bone, const EffectRoom& room)
    : HapticEffect(kScales | kReadsContacts),
      config_(config),
      specific_energy_({.reference = config.specific_energy,
                        .reference_density = config.reference_density,
                        .exponent = config.density_exponent,
                        .materials = all.materials},
                       all.properties, bone.volume.iso()),
      inverse_spacing_(bone.volume.spacing().cwiseInverse()),
      shift_(bone, room.largest_burr_reach, room.most_contacts, room.most_cells),
      most_contacts_(std::max<size_t>(1, room.most_cells / kCellsPerContact)) {}

void EnergyRemoval::begin(EffectTick& tick) noexcept {
    is_cutting_ = tick.may_mill && !tick.is_add_wanted && tick.spin_speed != 0;
    takeTurn(tick);
    removal_power_ = removed_energy_ = 0;
}

// The number of groups changes only when each has had its turn.
void EnergyRemoval::takeTurn(const EffectTick& tick) noexcept {
    if (++turn_ < turns_) return;
    turn_ = 0;
    leaf_turns_.clear();
    turns_ = tick.contacts.size() / most_contacts_ + 1;
}

// The contacts of a patch follow each other.
void EnergyRemoval::shareLeaves(const EffectTick& tick) noexcept {
    PatchId last;
    bool is_first = true;
    for (size_t n = 0; n < tick.contacts.size(); ++n) {
        if (!tick.is_on_burr[n]) continue;
        const PatchId patch = tick.candidates->patch[tick.contacts[n].candidate];
        if (is_first || patch != last) leaf_turns_.count(patch.leaf, 1);
        is_first = false;
        last = patch;
    }
    leaf_turns_.share(turns_);
}

double EnergyRemoval::scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                            const ToolField& tool, const Pose& X_VT) noexcept {
    if (!is_cutting_ || candidates.count == 0) return 1;
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const double slack = burrSlack(tool);
    const IntoTool<float> into_tool(X_VT, origin_V);
    PointBatch<float> batch;
    float distance[kBatch];
    double largest = 0;
    for (size_t first = 0; first < candidates.count; first += kBatch) {
        const int count = int(std::min(size_t(kBatch), candidates.count - first));
        into_tool.fill(batch, &candidates.x[first], &candidates.y[first], &candidates.z[first], count);
        tool.distances(batch, distance);
        for (int i = 0; i < count; ++i) {
            const size_t n = first + size_t(i);
            const Eigen::Vector3d p_T(batch.x[i], batch.y[i], batch.z[i]);
            // The burr is what it touches or is nearest to.
            const bool is_on_burr =
                tick.tool->burr.signedDistance(p_T) <= std::max(0.0, double(distance[i])) + slack;
            const double factor = is_on_burr ? softness(tick, candidates, n, origin_V, p_T) : 1;
            candidates.weight[n] *= float(factor);
            largest = std::max(largest, factor);
        }
    }
    return largest;
}

// This is 1/(1 + κ c dt) of a candidate on the burr.
double EnergyRemoval::softness(const EffectTick& tick, const Candidates& candidates, size_t n,
                               const Eigen::Vector3d& origin_V, const Eigen::Vector3d& p_T) noexcept {
    const Burr& burr = tick.tool->burr;
    const double area = double(tick.place_area[n]), stiffness = double(candidates.weight[n]) / area;
    const double rho = std::sqrt(p_T.x() * p_T.x() + p_T.z() * p_T.z() + patchSpread(area));
    const double u = energyFactor(burr) * specificEnergyAt(origin_V + candidates.position(n).cast<double>());
    const double c = burr.friction * std::abs(tick.spin_speed) * rho / u;
    return 1 / (1 + stiffness * c * tick.dt * double(turns_));
}

// The places of a patch follow each other.
double EnergyRemoval::specificEnergyAt(const Eigen::Vector3d& p_V) noexcept {
    const Eigen::Vector3i cell = (p_V.array() * inverse_spacing_).floor().cast<int>();
    if (cell != last_cell_) last_energy_ = specific_energy_.ofCell(last_cell_ = cell);
    return last_energy_;
}

// The burr's box is cut into equal boxes along the tool's axes.
size_t EnergyRemoval::regionOf(const EffectTick& tick, const SurfaceContact& contact) noexcept {
    const Burr& burr = tick.tool->burr;
    const Eigen::Vector3d half(burr.radius, std::max(burr.radius, burr.length / 2), burr.radius);
    const Eigen::Vector3d r_T = tick.X_VT.rotation.conjugate() * contact.r_V.cast<double>();
    const Eigen::Array3d place = (r_T.array() / half.array() + 1) * (kRegionsPerAxis / 2.0);
    const Eigen::Array3i at = place.floor().max(0.0).min(kRegionsPerAxis - 1.0).cast<int>();
    return size_t(at.x() + kRegionsPerAxis * (at.y() + kRegionsPerAxis * at.z()));
}

// The contacts of a patch follow each other. Together they have the area of the whole patch, each in
// proportion to its own.
void EnergyRemoval::weighRegions(const EffectTick& tick) noexcept {
    regions_.fill({});
    const auto placeArea = [&](size_t n) { return double(tick.place_area[tick.contacts[n].candidate]); };
    for (size_t n = 0, end = 0; n < tick.contacts.size(); n = end) {
        const uint32_t candidate = tick.contacts[n].candidate;
        const PatchId patch = tick.candidates->patch[candidate];
        double touching = 0;
        for (; end < tick.contacts.size() && tick.candidates->patch[tick.contacts[end].candidate] == patch;
             ++end)
            if (tick.is_on_burr[end]) touching += placeArea(end);
        const double times = double(tick.candidates->area[candidate]) / touching;
        for (size_t of_patch = n; of_patch < end; ++of_patch) {
            if (!tick.is_on_burr[of_patch]) continue;
            Region& region = regions_[regionOf(tick, tick.contacts[of_patch])];
            region.force += double(tick.contacts[of_patch].force);
            region.area += times * placeArea(of_patch);
        }
    }
}

double EnergyRemoval::shareAboveThreshold(const EffectTick& tick,
                                          const SurfaceContact& contact) const noexcept {
    if (!(config_.threshold_pressure > 0)) return 1;
    const Region& region = regions_[regionOf(tick, contact)];
    return std::max(0.0, 1 - config_.threshold_pressure * region.area / region.force);
}

// Gives the energies of the contacts whose turn it is to the surface. Returns the sum of all, J.
double EnergyRemoval::spendContacts(const EffectTick& tick, const BoneModel& bone) noexcept {
    const Burr& burr = tick.tool->burr;
    const Eigen::Vector3d axis = tick.X_VT.rotation * Eigen::Vector3d::UnitY();
    shift_.begin(bone, tick.X_VT.position);
    if (config_.threshold_pressure > 0) weighRegions(tick);
    if (turns_ > 1 && turn_ == 0) shareLeaves(tick);
    double energy = 0;
    LeafId leaf = ~LeafId(0);  // of the contact before
    bool is_its_turn = true;
    for (size_t n = 0; n < tick.contacts.size(); ++n) {
        if (!tick.is_on_burr[n]) continue;
        const SurfaceContact& contact = tick.contacts[n];
        const double area = double(tick.place_area[contact.candidate]);
        const double speed =
            std::abs(tick.spin_speed) * rubbingRadius(contact.r_V.cast<double>(), axis, area);
        const double above = double(contact.force) * shareAboveThreshold(tick, contact);
        const double of_contact = burr.friction * speed * above * tick.dt;
        energy += of_contact;
        const PatchId patch = tick.candidates->patch[contact.candidate];
        if (turns_ > 1 && patch.leaf != leaf) is_its_turn = leaf_turns_.turnOf(patch.leaf, turns_) == turn_;
        leaf = patch.leaf;
        if (!is_its_turn) continue;
        shift_.add(bone, patch, of_contact * double(turns_), double(contact.depth));
    }
    removal_power_ = energy / tick.dt;
    return energy;
}

void EnergyRemoval::mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept {
    if (!is_cutting_ || tick.contacts.empty()) return;
    const double energy = spendContacts(tick, bone);
    if (!(energy > 0)) return;
    const double factor = energyFactor(tick.tool->burr);
    if (turn_ == 0) to_repay_ = account_;
    const double of_turns = energy * double(turns_);
    const double repaid = to_repay_ * (1 - pinned::exp(-tick.dt * double(turns_) / kRepayTime));
    const double share = std::clamp((of_turns + repaid) / of_turns, 0.0, kMaxShare);
    removed_energy_ = factor * shift_.apply(bone, specific_energy_, share / factor,
                                            std::min(turns_ * size_t(tick.periods), kMaxTurnsAtOnce), result);
    account_ += energy - removed_energy_;
    // What the surface could not take, as it was too quick or there was no time, is lost.
    account_ = std::min(account_, energy * kRepayTime / tick.dt);
}

void EnergyRemoval::finish(EffectTick& tick) noexcept {
    tick.record.removal_power = float(removal_power_);
    tick.record.removed_energy = float(removed_energy_);
}

std::unique_ptr<HapticEffect> EnergyRemovalConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<EnergyRemoval>(*this, needs.all, needs.bone, needs.room);
}

}  // namespace bonemill
