// Ticks as the columns of an HDF5 file, with units and frames (docs/teach/replay.md lists them). It is for
// one normal thread.
#pragma once

#include <vector>

#include "haptic_server/recording/export/h5_file.h"
#include "haptic_server/recording/statistics/tick_columns.h"

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
    struct Column {
        TickColumn about;
        H5File::Column* column;
        std::vector<double> reals;     // that wait,
        std::vector<uint32_t> counts;  // or these
    };
    std::vector<Column> columns_;
    size_t rows_ = 0;  // that wait
};

}  // namespace bonemill
