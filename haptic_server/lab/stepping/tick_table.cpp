#include "haptic_server/lab/stepping/tick_table.h"

#include <span>

namespace bonemill {
namespace {

TickTable::Column columnOf(const TickColumn& is) {
    TickTable::Column column{is, is.name ? is.name : is.trace_names, 1, {}};
    const TickRecord none{};
    std::visit(
        [&column]<class Value>(const Value& value) {
            if constexpr (std::is_same_v<Value, std::span<const double>>) {
                column.width = value.size();
                column.values = std::vector<double>();
            } else {
                column.values = std::vector<Value>();
            }
        },
        is.in(none));
    return column;
}

}  // namespace

TickTable::TickTable(const RecordedEffects& recorded) {
    for (const TickColumn& column : tickColumns(recorded)) columns_.push_back(columnOf(column));
}

void TickTable::reserve(size_t ticks) {
    for (Column& column : columns_)
        std::visit([&](auto& values) { values.reserve(ticks * column.width); }, column.values);
}

void TickTable::add(const TickRecord& record) {
    for (Column& column : columns_)
        std::visit(
            [&column]<class Value>(const Value& value) {
                if constexpr (std::is_same_v<Value, std::span<const double>>) {
                    auto& values = std::get<std::vector<double>>(column.values);
                    values.insert(values.end(), value.begin(), value.end());
                } else {
                    std::get<std::vector<Value>>(column.values).push_back(value);
                }
            },
            column.is.in(record));
}

}  // namespace bonemill
