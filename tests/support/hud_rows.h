// Finds a line of the head-up display by what stands at its left.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "render_client/look/hud/hud.h"

namespace bonemill::test {

// The row is the list's; null where there is none.
inline const HudRow* findRow(const std::vector<HudRow>& rows, const std::string& label) {
    const auto row = std::ranges::find(rows, label, &HudRow::label);
    return row == rows.end() ? nullptr : &*row;
}

}  // namespace bonemill::test
