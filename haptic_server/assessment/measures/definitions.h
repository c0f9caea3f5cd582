// The list of what is measured of technique: each figure's name, version, words and unit, once. What the
// formulas are stands in docs/teach/assessment.md, and a definition that changes there gets another version
// here.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {

struct Definition {
    const char* id;
    int version;
    const char* label;
    const char* unit;
};

std::span<const Definition> techniqueDefinitions();

// Adds the figure of this definition, whose value is in the definition's unit; `of` is the burr, structure or
// range that it is about, if it is about one. A value that is not finite has nothing to say and is left out.
void put(Figures& figures, std::string_view id, double value, const std::string& of = "");

}  // namespace bonemill
