// Finds words and controls that a window of Dear ImGui has no room for: what reaches over the right edge of
// that in which it stands. Letters that are beyond it altogether are not drawn at all; the one before them
// comes near the edge.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>

namespace bonemill::test {

// A letter shows an area of the font's picture; all else shows one place of it, or a line.
inline bool isLetter(const std::array<ImDrawVert, 3>& corners) {
    const auto [left, right] = std::ranges::minmax_element(corners, {}, [](const auto& v) { return v.uv.x; });
    const auto [top, bottom] = std::ranges::minmax_element(corners, {}, [](const auto& v) { return v.uv.y; });
    return left->uv.x < right->uv.x && top->uv.y < bottom->uv.y;
}

// Returns where something is cut (pixels), of what stands left of `until`; empty: nowhere. `letters` takes
// how many are drawn.
inline std::string placesOfCuts(const ImDrawData& drawing, int& letters, float until = 1e6f) {
    constexpr float kNear = 1.5f, kRounding = 1;  // pixels
    std::string places;
    for (int n = 0; n < drawing.CmdListsCount; ++n) {
        const ImDrawList& list = *drawing.CmdLists[n];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            if (command.ClipRect.z > until) continue;
            for (unsigned first = 0; first + 2 < command.ElemCount; first += 3) {
                const ImDrawIdx* const index = &list.IdxBuffer[int(command.IdxOffset + first)];
                const std::array<ImDrawVert, 3> corners{list.VtxBuffer[index[0]], list.VtxBuffer[index[1]],
                                                        list.VtxBuffer[index[2]]};
                const bool is_letter = isLetter(corners);
                letters += is_letter;
                const auto right = std::ranges::max(corners, {}, [](const auto& v) { return v.pos.x; }).pos.x;
                if (right <= command.ClipRect.z + (is_letter ? -kNear : kRounding)) continue;
                places +=
                    " " + std::to_string(int(corners[0].pos.x)) + "," + std::to_string(int(corners[0].pos.y));
            }
        }
    }
    return places;
}

}  // namespace bonemill::test
