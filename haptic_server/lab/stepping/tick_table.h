// What ticks say, column by column, for programs that compute with whole columns: those of traces and exports
// (statistics/tick_columns.h). One normal thread.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "haptic_server/recording/statistics/tick_columns.h"

namespace bonemill {

class TickTable {
  public:
    struct Column {
        TickColumn is;
        std::string name;
        size_t width = 1;  // numbers a tick
        std::variant<std::vector<double>, std::vector<float>, std::vector<uint32_t>> values;
    };

    explicit TickTable(const RecordedEffects& recorded);

    void reserve(size_t ticks);
    void add(const TickRecord& record);
    std::vector<Column>& columns() noexcept { return columns_; }

  private:
    std::vector<Column> columns_;
};

}  // namespace bonemill
