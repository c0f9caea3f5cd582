#include "haptic_server/recording/export/tick_table.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr size_t kMostWaiting = 4096;  // rows

enum class Part { kAlways, kBurr, kHeat, kProtection, kAnyEffect };

using Reals = std::vector<double>;
using Counts = std::vector<uint32_t>;

template <class Value>
struct About {
    const char* name;
    size_t width;
    const char* unit;
    const char* description;
    Part part;
    void (*fill)(const TickRecord& record, std::vector<Value>& out);
};

template <size_t N>
void put(Reals& out, const double (&values)[N]) {
    out.insert(out.end(), values, values + N);
}

constexpr About<double> kReals[] = {
    {"t_s", 1, "s", "since the session's first tick", Part::kAlways,
     [](const TickRecord& r, Reals& out) { out.push_back(r.t_s); }},
    {"tool_p_m", 3, "m", "position of the simulated tool after the tick, world frame W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.p_WT); }},
    {"tool_q_wxyz", 4, "1", "orientation of the simulated tool, quaternion w, x, y, z, T to W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.q_WT); }},
    {"hand_p_m", 3, "m", "where the hand holds the tool, as accepted, W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.p_WT_device); }},
    {"hand_q_wxyz", 4, "1", "orientation of the hand's tool, quaternion w, x, y, z, T to W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.q_WT_device); }},
    {"force_n", 3, "N", "force on the hand, W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.f_hand_W); }},
    {"torque_nm", 3, "N m", "torque on the hand about the tool point that it holds, W", Part::kAlways,
     [](const TickRecord& r, Reals& out) { put(out, r.t_hand_W); }},
    {"penetration_m", 1, "m", "deepest contact", Part::kAlways,
     [](const TickRecord& r, Reals& out) { out.push_back(r.max_penetration); }},
    {"removed_mm3", 1, "mm^3", "bone that fell below the iso-value in this tick", Part::kAlways,
     [](const TickRecord& r, Reals& out) { out.push_back(r.removed * kPerCubicMillimetre); }},
    {"added_mm3", 1, "mm^3", "bone that rose to the iso-value in this tick", Part::kAlways,
     [](const TickRecord& r, Reals& out) { out.push_back(r.added * kPerCubicMillimetre); }},
    {"stale_factor", 1, "1", "share of the force while the device is silent", Part::kAlways,
     [](const TickRecord& r, Reals& out) { out.push_back(r.input.stale_factor); }},
    {"spin_rpm", 1, "1/min", "speed of the burr about T's +y", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(double(r.effects.spin_speed) / kRpm); }},
    {"burr_force_n", 1, "N", "sum of the normal forces on the burr", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.burr_force); }},
    {"axis_torque_nm", 1, "N m", "torque against the spin, on the tool", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.axis_torque); }},
    {"cutting_power_w", 1, "W", "power of all friction between burr and bone", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.cutting_power); }},
    {"removal_power_w", 1, "W", "the part of it that removes bone", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.removal_power); }},
    {"removed_energy_j", 1, "J", "specific energy of what was removed in this tick", Part::kBurr,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.removed_energy); }},
    {"temperature_c", 1, "degC", "of the hottest bone", Part::kHeat,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.temperature); }},
    {"necrotic_mm3", 1, "mm^3", "dead bone in all", Part::kHeat,
     [](const TickRecord& r, Reals& out) {
         out.push_back(double(r.effects.necrotic_volume) * kPerCubicMillimetre);
     }},
    {"protected_distance_mm", 1, "mm", "burr's surface to the nearest structure; of no meaning with id 0",
     Part::kProtection,
     [](const TickRecord& r, Reals& out) {
         out.push_back(double(r.effects.protected_distance) * kPerMillimetre);
     }},
    {"protected_force_n", 1, "N", "on the tool, from protected structures", Part::kProtection,
     [](const TickRecord& r, Reals& out) { out.push_back(r.effects.protected_force); }},
    {"damaged_mm3", 1, "mm^3", "protected structures removed in all", Part::kProtection,
     [](const TickRecord& r, Reals& out) {
         out.push_back(double(r.effects.damaged_volume) * kPerCubicMillimetre);
     }},
};

constexpr About<uint32_t> kCounts[] = {
    {"buttons", 1, "bits", "1 removes, 2 adds", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.buttons); }},
    {"contacts", 1, "1", "samples in contact", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.contacts); }},
    {"removed_voxels", 1, "1", "that fell below the iso-value in this tick", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.removed_voxels); }},
    {"faults", 1, "bits", "TickFault bits (docs/research/simulate.md)", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.faults); }},
    {"tool_index", 1, "1", "of the file's attribute tools, from 0", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.input.decisions.tool); }},
    {"device_state", 1, "1", "SafetyState (docs/lab/safety.md)", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(r.device.state); }},
    {"periods", 1, "1", "of the loop that the tick stands for", Part::kAlways,
     [](const TickRecord& r, Counts& out) { out.push_back(uint32_t(r.input.periods)); }},
    {"protected_id", 1, "1", "1 + index of the nearest structure's material; 0: none in reach",
     Part::kProtection, [](const TickRecord& r, Counts& out) { out.push_back(r.effects.protected_id); }},
    {"events", 1, "bits", "1 spindle stalled, 2 near a structure, 4 touched, 8 damaged, 16 bone too hot",
     Part::kAnyEffect, [](const TickRecord& r, Counts& out) { out.push_back(r.effects.events); }},
};

bool isThere(Part part, const RecordedEffects& recorded) {
    switch (part) {
        case Part::kAlways:
            return true;
        case Part::kBurr:
            return recorded.burr;
        case Part::kHeat:
            return recorded.heat;
        case Part::kProtection:
            return recorded.protection;
        case Part::kAnyEffect:
            return recorded.any();
    }
    return false;
}

}  // namespace

TickTable::TickTable(H5File& file, const RecordedEffects& recorded) {
    const auto add = [&](const auto& abouts, auto& columns, H5File::Number number) {
        for (const auto& about : abouts)
            if (isThere(about.part, recorded))
                columns.push_back({&file.addColumn(std::string("/tick/") + about.name, about.width, number,
                                                   {about.unit, about.description}),
                                   about.fill,
                                   {}});
    };
    add(kReals, reals_, H5File::Number::kDouble);
    add(kCounts, counts_, H5File::Number::kUint32);
}

void TickTable::add(const TickRecord& record) {
    for (auto& column : reals_) column.fill(record, column.waiting);
    for (auto& column : counts_) column.fill(record, column.waiting);
    if (++rows_ == kMostWaiting) flush();
}

void TickTable::flush() {
    const auto write = [](auto& columns) {
        for (auto& column : columns) {
            column.column->append(column.waiting);
            column.waiting.clear();
        }
    };
    write(reals_);
    write(counts_);
    rows_ = 0;
}

}  // namespace bonemill
