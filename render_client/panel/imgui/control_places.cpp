#include "render_client/panel/imgui/control_places.h"

#include <imgui.h>

#include <algorithm>

namespace bonemill {

void notePlace(ControlPlaces& places, const std::string& label) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 seen_low = ImGui::GetWindowDrawList()->GetClipRectMin(),
                 seen_high = ImGui::GetWindowDrawList()->GetClipRectMax();
    const float left = std::max(low.x, seen_low.x), right = std::min(high.x, seen_high.x);
    const float y = (low.y + high.y) / 2;
    if (left < right && y > seen_low.y && y < seen_high.y)
        places[label] = {double(left + right) / 2, double(y)};
}

}  // namespace bonemill
