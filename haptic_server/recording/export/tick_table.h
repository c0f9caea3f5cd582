// Ticks as the columns of an HDF5 file, with units and frames (docs/teach/replay.md lists them). It is for
// one normal thread.
#pragma once

#include <vector>

#include "haptic_server/core/telemetry/recorded_effects.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/recording/export/h5_file.h"

namespace bonemill {

class TickTable {
  public:
    // Adds the columns below "/tick/", those of effects as the scene records them. The file must outlive the
    // table.
    TickTable(H5File& file, const RecordedEffects& recorded);

    void add(const TickRecord& record);
    // What waits; before the file is closed.
    void flush();

  private:
    template <class Value>
    struct Column {
        H5File::Column* column;
        void (*fill)(const TickRecord& record, std::vector<Value>& out);
        std::vector<Value> waiting;
    };
    std::vector<Column<double>> reals_;
    std::vector<Column<uint32_t>> counts_;
    size_t rows_ = 0;  // that wait
};

}  // namespace bonemill
