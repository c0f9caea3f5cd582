// Finds the unit that a scene field carries as the suffix of its name.
#pragma once

#include <string>
#include <string_view>

namespace bonemill {

// It is "mm/s" for max_speed_mm_per_s and empty for a plain number. Any thread may call it; it
// is not RT-safe.
std::string_view unitOfField(std::string_view field_name) noexcept;

// Writes a number as people do (0.25, 100000, 1e+09): the shortest text that reads back as the same double.
std::string numberText(double value);

}  // namespace bonemill
