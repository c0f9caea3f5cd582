#include "haptic_server/recording/export/tick_table.h"

#include <string>
#include <type_traits>

namespace bonemill {
namespace {

constexpr size_t kMaxWaiting = 4096;  // rows

}  // namespace

TickTable::TickTable(H5File& file, const RecordedEffects& recorded) {
    static const TickRecord kAny{};
    for (const TickColumn& about : tickColumns(recorded)) {
        if (!about.name) continue;
        const ColumnValue value = about.in(kAny);
        const auto* const vector = std::get_if<std::span<const double>>(&value);
        const auto number =
            std::holds_alternative<uint32_t>(value) ? H5File::Number::kUint32 : H5File::Number::kDouble;
        columns_.push_back({about,
                            &file.addColumn(std::string("/tick/") + about.name, vector ? vector->size() : 1,
                                            number, {about.unit, about.description}),
                            {},
                            {}});
    }
}

void TickTable::add(const TickRecord& record) {
    for (Column& column : columns_)
        std::visit(
            [&]<class Value>(const Value& value) {
                if constexpr (std::is_same_v<Value, uint32_t>)
                    column.counts.push_back(value);
                else if constexpr (std::is_arithmetic_v<Value>)
                    column.reals.push_back(double(value));
                else
                    column.reals.insert(column.reals.end(), value.begin(), value.end());
            },
            column.about.in(record));
    if (++rows_ == kMaxWaiting) flush();
}

void TickTable::flush() {
    for (Column& column : columns_) {
        if (column.counts.empty())
            column.column->append(column.reals);
        else
            column.column->append(column.counts);
        column.reals.clear();
        column.counts.clear();
    }
    rows_ = 0;
}

}  // namespace bonemill
