// An effect declares each figure that it records as one of these: the column of its ticks, how a run sums it
// up, and how people see it. Traces, exports, reports, digests and viewers go by the declarations
// (effects/effect_figures.h). Plain constants; any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>

#include "haptic_server/core/telemetry/effect_record.h"

namespace bonemill {

// What a tick says in one column, with the type that it is written in.
using ColumnValue = std::variant<double, float, uint32_t, std::span<const double>>;

// Figures that are no number say nothing. Without ticks kLargestSize, kSum and kLast are 0, the others not
// there.
enum class RunSummary {
    kNone,
    kLargest,
    kLargestSize,  // of the absolute value
    kMin,
    kSum,
    kLast,
};

// What a run makes of a figure.
struct RunFigure {
    RunSummary summary = RunSummary::kNone;
    const char* key = nullptr;    // in reports for programs, with its unit
    const char* words = nullptr;  // in reports for people; null: not there
};

// As people read a figure.
struct ShownAs {
    const char* unit = nullptr;
    double factor = 1;           // of the figure
    const char* line = nullptr;  // the label of a line of viewers; null: they show none, or one of their own
};

constexpr int kNoSlot = -1;

// Reads a figure from a record, or is not there. A class, since with -fsanitize=undefined GCC's constant
// expressions may not ask whether a function's address is null.
class FigureReader {
  public:
    constexpr FigureReader() = default;
    template <class Read>
    requires(!std::is_null_pointer_v<Read> &&
             std::is_convertible_v<
                 Read, ColumnValue (*)(const EffectRecord&)>) constexpr FigureReader(Read read) noexcept
        : read_(read), is_there_(true) {}
    constexpr explicit operator bool() const noexcept { return is_there_; }
    ColumnValue operator()(const EffectRecord& record) const { return read_(record); }

  private:
    ColumnValue (*read_)(const EffectRecord&) = nullptr;
    bool is_there_ = false;
};

struct EffectFigure {
    // The column's name with its unit, the unit and words of exports; null: no column.
    const char* name = nullptr;
    const char* unit = nullptr;
    const char* description = nullptr;
    // Without: the figure is one of EffectRecord::own, which effects/effect_figures.h gives it.
    FigureReader value = {};
    RunFigure run = {};
    ShownAs shown = {};
    bool (*has_meaning)(const EffectRecord&) = nullptr;  // null: always
    // Both follow from the effect that declares it (effects/effect_figures.h): it is told where one of these
    // is recorded, and has this place in EffectRecord::own.
    RecordedEffects told_with = {};
    int slot = kNoSlot;

    ColumnValue in(const EffectRecord& record) const {
        return value ? value(record) : ColumnValue(record.own[slot]);
    }
    // As a number; NaN where it has no meaning.
    double numberIn(const EffectRecord& record) const {
        if (has_meaning && !has_meaning(record)) return std::numeric_limits<double>::quiet_NaN();
        const ColumnValue is = in(record);
        if (const auto* const number = std::get_if<double>(&is)) return *number;
        if (const auto* const number = std::get_if<float>(&is)) return double(*number);
        return double(std::get<uint32_t>(is));
    }
    bool isToldBy(const RecordedEffects& recorded) const noexcept { return recorded.hasAnyOf(told_with); }
};

}  // namespace bonemill
