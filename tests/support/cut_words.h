// Finds words that a window of Dear ImGui has no room for: letters that the right edge of what they stand in
// cuts off.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>

namespace bonemill::test {

// A letter is a quad that shows an area of the font's picture; all else shows one place of it, or a line.
inline bool isLetter(const std::array<ImDrawVert, 4>& quad) {
    const auto [left, right] = std::ranges::minmax_element(quad, {}, [](const auto& v) { return v.uv.x; });
    const auto [top, bottom] = std::ranges::minmax_element(quad, {}, [](const auto& v) { return v.uv.y; });
    return left->uv.x < right->uv.x && top->uv.y < bottom->uv.y;
}

// Returns where letters are cut (pixels); empty: nowhere. `letters` takes how many there are.
inline std::string placesOfCutLetters(const ImDrawData& drawing, int& letters) {
    std::string places;
    for (int n = 0; n < drawing.CmdListsCount; ++n) {
        const ImDrawList& list = *drawing.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            for (unsigned first = 0; first + 5 < command.ElemCount; first += 3) {
                const ImDrawIdx* const index = &list.IdxBuffer[int(command.IdxOffset + first)];
                if (index[3] != index[0] || index[4] != index[2]) continue;  // no quad
                const std::array<ImDrawVert, 4> quad{list.VtxBuffer[index[0]], list.VtxBuffer[index[1]],
                                                     list.VtxBuffer[index[2]], list.VtxBuffer[index[5]]};
                if (!isLetter(quad)) continue;
                ++letters;
                const auto right = std::ranges::max(quad, {}, [](const auto& v) { return v.pos.x; }).pos.x;
                if (right <= command.ClipRect.z + 1) continue;
                places += " " + std::to_string(int(quad[0].pos.x)) + "," + std::to_string(int(quad[0].pos.y));
            }
        }
    }
    return places;
}

}  // namespace bonemill::test
