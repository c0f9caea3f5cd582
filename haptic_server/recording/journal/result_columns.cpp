#include "haptic_server/recording/journal/result_columns.h"

#include <utility>

#include "common/base/units.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

template <class Column, size_t N>
void addAll(Column* column, const double (&values)[N]) {
    for (const double value : values) column->Add(typename Column::value_type(value));
}

}  // namespace

void ResultColumns::add(const TickRecord& record) {
    if (isEmpty()) results_.set_first_tick(record.tick);
    results_.set_count(results_.count() + 1);
    addAll(results_.mutable_tool_m(), record.p_WT);
    addAll(results_.mutable_tool_q(), record.q_WT);
    addAll(results_.mutable_force_n(), record.f_hand_W);
    addAll(results_.mutable_torque_nm(), record.t_hand_W);
    results_.add_contacts(record.contacts);
    results_.add_penetration_m(float(record.max_penetration));
    results_.add_removed_mm3(float(record.removed * kPerCubicMillimetre));
    results_.add_faults(record.faults);
    results_.add_compute_us(float(microsecondsOfNs(double(record.compute_ns))));
    results_.add_events(record.effects.events);
    results_.add_burr_force_n(record.effects.burr_force);
    results_.add_temperature_c(record.effects.temperature);
    results_.add_damaged_mm3(float(double(record.effects.damaged_volume) * kPerCubicMillimetre));
    results_.add_protected_id(record.effects.protected_id);
    results_.add_protected_distance_m(record.effects.protected_distance);
}

journal::Results ResultColumns::take() {
    return std::exchange(results_, {});
}

}  // namespace bonemill
