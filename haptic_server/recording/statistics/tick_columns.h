// What files say of each tick: one column after the other, for traces (CSV) and exports (HDF5) alike. For
// normal threads.
//
// W is the world frame (the volume file's physical frame); force and torque act on the hand.
#pragma once

#include <cstdio>
#include <memory>
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

// Writes one CSV line per tick: the same file from a live session and from `simulate`, so that plots
// and checks compare.
//
// The columns are those that have names in traces. Numbers round-trip, masks are decimal
// numbers. It belongs to one normal thread.
class TraceWriter {
  public:
    // Creates or empties the file and writes the header. Throws UserError when it cannot be written.
    explicit TraceWriter(const std::string& path, const RecordedEffects& recorded = {});

    // It is false from then on once the file could not be written (disk full): the session goes
    // on without it.
    bool write(const TickRecord& record);

    // Flushes and closes; false if anything was lost. Without it the destructor closes silently.
    bool close();

  private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };

    std::vector<TickColumn> columns_;
    std::unique_ptr<std::FILE, Close> file_;
    std::string line_;
    bool is_good_ = true;
};

}  // namespace bonemill
