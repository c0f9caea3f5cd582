// What files say of each tick: one column after the other, for traces (CSV) and exports (HDF5) alike. For
// normal threads.
//
// W is the world frame (the volume file's physical frame); force and torque act on the hand.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/core/telemetry/effect_figure.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {

struct TickColumn {
    const char* name = nullptr;         // of the dataset in exports; null: not there
    const char* trace_names = nullptr;  // its columns in traces, with commas; null: not there
    const char* unit = nullptr;
    const char* description = nullptr;
    ColumnValue (*of_tick)(const TickRecord&) = nullptr;
    const EffectFigure* of_effects = nullptr;  // stands in for of_tick

    ColumnValue in(const TickRecord& record) const {
        return of_tick ? of_tick(record) : of_effects->in(record.effects);
    }
};

// The columns of a scene's ticks: those of every scene, then what its effects tell.
std::vector<TickColumn> tickColumns(const RecordedEffects& recorded);

}  // namespace bonemill
