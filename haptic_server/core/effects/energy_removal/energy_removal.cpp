// Removes by pressure times cutting speed against the bone's specific energy (ALGORITHMS §4).
//
// Per area of the contact between burr and bone, with pressure p, friction μ_c and cutting speed v_c, the
// power μ_c (p - p_e)₊ v_c goes into bone of specific energy u, whose surface recedes at v_n = μ_c v_c (p -
// p_e)₊ / u (Archard's law of wear, its rate given by energy). The rest, p_e at most, is carried by edges,
// grains and wear flats, which rub with friction μ_e: μ_e min(p, p_e) v_c is heat and load of the motor only.
//
// p_e is in proportion to u. Edges that come by with E = z q_e in a turn (z edges, q_e each, N/m) have p_e =
// E/(2πρ) at ρ from the axis, so that a chip of thickness h = v_n 2π/(Ω z) takes u + u_1/h in all, with u_1 =
// μ_e q_e: the size effect of cutting. Grains of diamond lie as densely everywhere, p_e is constant.
//
// The time constant of that wear against the contact's stiffness κ (N/m³), u/(μ_c κ v_c), is shorter than a
// tick. The tick therefore takes it implicitly (backward Euler). With c = μ_c v_c / u and the recession s =
// dt c p in this tick, p = κ (δ - s) makes p = κ δ / (1 + κ c dt): scale() multiplies each point's weight by
// 1/(1 + κ c dt), so that the solve moves the tool through what the tick will cut. At a steady feed v the
// pressure is v/c whatever dt and κ. p_e is not in the weights: below it the burr only rubs, on
// bone as soft as that, and sinks in by dt c p_e more. (A weight by the depth of the tick before swings: its
// gain is κ c dt p_e/p.)
//
// v_c = |Ω| ρ with the mean of ρ over the point's patch (burr_speed.h), so that the pole of a burr cuts,
// if hardly.
//
// Bone under a large burr takes turns: with more contacts than a tick has time for, the leaves mill in
// `turns` groups with about as many patches each (leaf_turns.h), each in every turns-th tick and for as many
// ticks at once (the weights, too, then know that dt).
//
// The cut surface is the burr's only within some micrometres, which is as much as the contact is deep: on
// coarse voxels, and with a stiff contact (a short tick), few places carry what many should, at pressures far
// above the mean. So the pressure that counts against p_e is the mean over a region of the burr,
// its force over the whole area of the patches that touch, and each contact gives its power times the share
// of that mean which is above. Of the burr's moment Σ F ρ the share that cuts is told to the other effects.
//
// mill() then spends the energy of the contacts on the surface (milling/surface_shift.h). What was spent too
// much or too little is kept in an account and made good within kRepayTime, so that Σ u ΔV = ∫ P dt but for
// what is in the account.
#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <utility>
#include <vector>

#include "common/math/pinned_math.h"
#include "haptic_server/core/contact/into_tool.h"
#include "haptic_server/core/effects/burr_speed.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/energy_removal/leaf_turns.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/milling/surface_shift.h"
#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {
namespace {

class EnergyRemoval final : public HapticEffect {
  public:
    static constexpr double kRepayTime = 5e-3;    // s
    static constexpr double kMaxShare = 2;        // of a tick's energy, that it may spend
    static constexpr size_t kMaxTurnsAtOnce = 3;  // or periods, that a surface may make good in a tick

    // The bone's properties and materials are taken from `all`.
    EnergyRemoval(const EnergyRemovalConfig& config, const EffectConfigs& all, const BoneModel& bone,
                  const EffectRoom& room)
        : HapticEffect(kScales | kReadsContacts),
          config_(config),
          specific_energy_({.reference = config.specific_energy,
                            .reference_density = config.reference_density,
                            .exponent = config.density_exponent,
                            .materials = all.materials},
                           all.properties, bone.volume.iso()),
          inverse_spacing_(bone.volume.spacing().cwiseInverse()),
          rubbing_(room.most_contacts),
          region_of_(room.most_contacts),
          shift_(bone, room.largest_burr_reach, room.most_contacts, room.most_cells),
          most_contacts_(std::max<size_t>(1, room.most_cells / EnergyRemovalConfig::kCellsPerContact)) {}
    void restart(Restart) noexcept override {
        account_ = to_repay_ = 0, turn_ = 0, turns_ = 1, leaf_turns_.clear();
    }
    void begin(EffectTick& tick) noexcept override {
        is_cutting_ = tick.may_mill && !tick.is_add_wanted && tick.spin_speed != 0;
        removed_energy_ = 0;
        if (!std::exchange(has_milled_, false)) return;  // the power is still that of the last time
        removal_power_ = 0;
        takeTurn(tick);
    }
    double scale(const EffectTick& tick, Candidates& candidates, const Eigen::Vector3d& origin_V,
                 const ToolField& tool, const Pose& X_VT) noexcept override {
        if (!is_cutting_ || candidates.count == 0) return 1;
        rubs_ = config_.rubbingPressure(tick.tool->burr, tick.tool->burr.radius) > 0;
        if (rubs_) std::fill_n(rubbing_.begin(), candidates.count, 0.f);
        const IntoTool<float> into_tool(X_VT, origin_V);
        Places places;
        double largest = 0;
        for (size_t first = 0; first < candidates.count; first += kBatch) {
            const size_t count = std::min(kBatch, candidates.count - first);
            into_tool.fill(places.at_T, &candidates.x[first], &candidates.y[first], &candidates.z[first],
                           int(count));
            tool.distances(places.at_T, places.tool_distance);
            measure(tick, candidates, first, origin_V, burrSlack(tool), places);
            soften(tick, &candidates.weight[first], first, places);
            for (size_t i = 0; i < count; ++i) largest = std::max(largest, places.factor[i]);
        }
        return largest;
    }
    void mill(EffectTick& tick, BoneModel& bone, MillingResult& result) noexcept override {
        has_milled_ = true;
        if (!is_cutting_ || tick.contacts.empty()) return;
        const double energy = spendContacts(tick, bone);
        if (!(energy > 0)) return;
        const double factor = config_.energyFactor(tick.tool->burr);
        if (turn_ == 0) to_repay_ = account_;
        const double of_turns = energy * double(turns_);
        const double repaid = to_repay_ * (1 - pinned::exp(-tick.milled_dt * double(turns_) / kRepayTime));
        const double share = std::clamp((of_turns + repaid) / of_turns, 0.0, kMaxShare);
        removed_energy_ =
            factor * shift_.apply(bone, specific_energy_, share / factor,
                                  std::min(turns_ * size_t(tick.milled_periods), kMaxTurnsAtOnce), result);
        account_ += energy - removed_energy_;
        // What the surface could not take, as it was too quick or there was no time, is lost.
        account_ = std::min(account_, energy * kRepayTime / tick.milled_dt);
    }
    void finish(EffectTick& tick) noexcept override {
        tick.record.removal_power = float(removal_power_);
        tick.record.removed_energy = float(removed_energy_);
    }

  private:
    static constexpr size_t kBatch = PointBatch<float>::kCapacity;
    // Candidates that are looked at together.
    struct Places {
        PointBatch<float> at_T;
        float tool_distance[kBatch];   // m
        double burr_distance[kBatch];  // m
        double rho[kBatch];            // m: of the place from the axis, the mean over it
        double of_bone[kBatch];        // J/m³; 0: it is not the burr's
        double factor[kBatch];         // of its weight
    };
    // The burr's is what it touches or is nearest to.
    void measure(const EffectTick& tick, const Candidates& candidates, size_t first,
                 const Eigen::Vector3d& origin_V, double slack, Places& at) noexcept {
        const Burr& burr = tick.tool->burr;
        const float *x = at.at_T.x, *y = at.at_T.y, *z = at.at_T.z, *area = &tick.place_area[first];
        const auto count = size_t(at.at_T.count);
        for (size_t i = 0; i < count; ++i) {
            const double off = double(x[i]) * double(x[i]) + double(z[i]) * double(z[i]);
            at.rho[i] = std::sqrt(off + patchSpread(double(area[i])));
            at.burr_distance[i] = std::sqrt(off + double(y[i]) * double(y[i])) - burr.radius;  // of a ball
        }
        if (burr.kind != BurrKind::kBall)
            for (size_t i = 0; i < count; ++i)
                at.burr_distance[i] = burr.signedDistance(Eigen::Vector3f(x[i], y[i], z[i]).cast<double>());
        for (size_t i = 0; i < count; ++i) {
            const bool is_on_burr = at.burr_distance[i] <= std::max(0.0, double(at.tool_distance[i])) + slack;
            at.of_bone[i] =
                is_on_burr ? specificEnergyAt(origin_V + candidates.position(first + i).cast<double>()) : 0;
        }
    }
    // Multiplies each weight by 1/(1 + κ c dt), and notes p_e.
    void soften(const EffectTick& tick, float* weight, size_t first, Places& at) noexcept {
        const Burr& burr = tick.tool->burr;
        const auto count = size_t(at.at_T.count);
        // u c dt per ρ: κ is the weight per area.
        const double wear = burr.friction * std::abs(tick.spin_speed) / config_.energyFactor(burr) *
                            tick.milled_dt * double(turns_);
        const float* area = &tick.place_area[first];
        for (size_t i = 0; i < count; ++i) {
            const double bone = at.of_bone[i] * double(area[i]);
            at.factor[i] = bone > 0 ? bone / (bone + double(weight[i]) * wear * at.rho[i]) : 1;
            weight[i] *= float(at.factor[i]);
        }
        if (!rubs_) return;
        for (size_t i = 0; i < count; ++i)
            if (at.of_bone[i] > 0)
                rubbing_[first + i] = float(config_.rubbingPressure(burr, at.rho[i]) *
                                            (at.of_bone[i] / config_.specific_energy));
    }
    struct Region {
        double force = 0, rubbing = 0;  // N: of its patches that touch, and what they carry without cutting
    };
    static constexpr int kRegionsPerAxis = 4;
    // The burr's box is cut into equal boxes along the tool's axes.
    static size_t regionOf(const EffectTick& tick, const SurfaceContact& contact) noexcept {
        const Burr& burr = tick.tool->burr;
        const Eigen::Vector3d half(burr.radius, std::max(burr.radius, burr.length / 2), burr.radius);
        const Eigen::Vector3d r_T = tick.X_VT.rotation.conjugate() * contact.r_V.cast<double>();
        const Eigen::Array3d place = (r_T.array() / half.array() + 1) * (kRegionsPerAxis / 2.0);
        const Eigen::Array3i at = place.max(0.0).min(kRegionsPerAxis - 1.0).cast<int>();
        return size_t(at.x() + kRegionsPerAxis * (at.y() + kRegionsPerAxis * at.z()));
    }
    // The contacts of a patch follow each other. Together they have the area of the whole patch, each in
    // proportion to its own.
    void weighRegions(const EffectTick& tick) noexcept {
        regions_.fill({});
        const auto placeArea = [&](size_t n) { return double(tick.place_area[tick.contacts[n].candidate]); };
        for (size_t n = 0, end = 0; n < tick.contacts.size(); n = end) {
            const uint32_t candidate = tick.contacts[n].candidate;
            const PatchId patch = tick.candidates->patch[candidate];
            double touching = 0;
            for (;
                 end < tick.contacts.size() && tick.candidates->patch[tick.contacts[end].candidate] == patch;
                 ++end)
                if (tick.is_on_burr[end]) touching += placeArea(end);
            const double times = double(tick.candidates->area[candidate]) / touching;
            for (size_t of_patch = n; of_patch < end; ++of_patch) {
                if (!tick.is_on_burr[of_patch]) continue;
                const SurfaceContact& contact = tick.contacts[of_patch];
                Region& region = regions_[region_of_[of_patch] = uint8_t(regionOf(tick, contact))];
                region.force += double(contact.force);
                region.rubbing += times * placeArea(of_patch) * double(rubbing_[contact.candidate]);
            }
        }
    }
    double cuttingShare(size_t contact) const noexcept {
        if (!rubs_) return 1;
        const Region& region = regions_[region_of_[contact]];
        return std::max(0.0, 1 - region.rubbing / region.force);
    }
    // The places of a patch follow each other.
    double specificEnergyAt(const Eigen::Vector3d& p_V) noexcept {
        const Eigen::Vector3i cell = floorIndices((p_V.array() * inverse_spacing_).matrix());
        if (cell != last_cell_) last_energy_ = specific_energy_.ofCell(last_cell_ = cell);
        return last_energy_;
    }
    // Gives the energies of the contacts whose turn it is to the surface. Returns the sum of all, J.
    double spendContacts(EffectTick& tick, const BoneModel& bone) noexcept {
        const Burr& burr = tick.tool->burr;
        shift_.begin(bone, burr, tick.X_VT);
        if (rubs_) weighRegions(tick);
        if (turns_ > 1 && turn_ == 0) shareLeaves(tick);
        double energy = 0, all_cutting = 0;
        LeafId leaf = ~LeafId(0);  // of the contact before
        bool is_its_turn = true;
        for (size_t n = 0; n < tick.contacts.size(); ++n) {
            if (!tick.is_on_burr[n]) continue;
            const SurfaceContact& contact = tick.contacts[n];
            const double speed = std::abs(tick.spin_speed) * tick.rubbing_radius[n];
            const double cutting = double(contact.force) * speed * cuttingShare(n);
            const double of_contact = burr.friction * cutting * tick.milled_dt;
            energy += of_contact;
            all_cutting += cutting;
            const PatchId patch = tick.candidates->patch[contact.candidate];
            if (turns_ > 1 && patch.leaf != leaf)
                is_its_turn = leaf_turns_.turnOf(patch.leaf, turns_) == turn_;
            leaf = patch.leaf;
            if (!is_its_turn) continue;
            shift_.add(bone, patch, of_contact * double(turns_), double(contact.depth));
        }
        removal_power_ = energy / tick.milled_dt;
        const double all = tick.burr_load.moment * std::abs(tick.spin_speed);
        tick.cut_share = rubs_ && all > 0 ? std::min(1.0, all_cutting / all) : 1;
        return energy;
    }
    // The number of groups changes only when each has had its turn.
    void takeTurn(const EffectTick& tick) noexcept {
        if (++turn_ < turns_) return;
        turn_ = 0;
        leaf_turns_.clear();
        turns_ = tick.contacts.size() / most_contacts_ + 1;
        if (tick.milling_thrift > 0)
            turns_ = std::max(turns_, std::min(turns_ << tick.milling_thrift, leavesOf(tick)));
    }
    // More turns than leaves would leave ticks without work. The contacts of a leaf mostly follow each other.
    static size_t leavesOf(const EffectTick& tick) noexcept {
        size_t leaves = 0;
        LeafId last = ~LeafId(0);
        for (const SurfaceContact& contact : tick.contacts)
            leaves += std::exchange(last, tick.candidates->patch[contact.candidate].leaf) != last;
        return leaves;
    }
    // The contacts of a patch follow each other.
    void shareLeaves(const EffectTick& tick) noexcept {
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

    EnergyRemovalConfig config_;
    SpecificEnergy specific_energy_;
    Eigen::Array3d inverse_spacing_;
    Eigen::Vector3i last_cell_ = Eigen::Vector3i::Constant(INT_MIN);  // and what it takes, J/m³
    double last_energy_ = 0;
    bool rubs_ = false;               // this burr does, too
    std::vector<float> rubbing_;      // p_e, Pa: of candidates on the burr
    std::vector<uint8_t> region_of_;  // of contacts on the burr
    std::array<Region, size_t(kRegionsPerAxis* kRegionsPerAxis* kRegionsPerAxis)> regions_{};
    SurfaceShift shift_;
    size_t most_contacts_;
    size_t turn_ = 0, turns_ = 1;
    LeafTurns leaf_turns_;
    bool is_cutting_ = false;
    bool has_milled_ = true;  // in the tick before
    double account_ = 0;      // J not yet spent; negative: too much was
    double to_repay_ = 0;     // J: the account when the turns began
    // These are of this tick.
    double removal_power_ = 0, removed_energy_ = 0;
};

}  // namespace

std::unique_ptr<HapticEffect> EnergyRemovalConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<EnergyRemoval>(*this, needs.all, needs.bone, needs.room);
}

}  // namespace bonemill
