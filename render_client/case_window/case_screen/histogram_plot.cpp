#include "render_client/case_window/case_screen/histogram_plot.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "render_client/look/slices/grey_window.h"

namespace bonemill {
namespace {

// Counts from 1 to the most frequent value's, as parts of the plot's height. A scan's air would hide all else
// on a linear scale.
float heightOf(double count, double most) {
    return count < 1 || most <= 1 ? 0 : float(std::log1p(count) / std::log1p(most));
}

}  // namespace

std::optional<double> plotHistogram(const Histogram& histogram, const std::optional<double>& iso,
                                    const std::optional<double>& runner_up, const GreyWindow& window,
                                    float height, ControlPlaces& places) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
    ImGui::InvisibleButton("histogram", size);
    notePlace(places, "histogram");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 high(low.x + size.x, low.y + size.y);
    draw.AddRectFilled(low, high, IM_COL32(12, 16, 20, 255), 3);
    const double range = histogram.width * double(histogram.count.size());
    if (range <= 0) return std::nullopt;
    const double most = *std::ranges::max_element(histogram.count);
    const float step = size.x / float(histogram.count.size());
    for (size_t bin = 0; bin < histogram.count.size(); ++bin) {
        const auto grey = int(70 + 185 * greyOf(window, histogram.centre(bin)));
        const float top = high.y - 0.94f * size.y * heightOf(histogram.count[bin], most);
        draw.AddRectFilled(ImVec2(low.x + step * float(bin), top),
                           ImVec2(low.x + step * float(bin + 1), high.y), IM_COL32(grey, grey, grey, 255));
    }
    const auto line = [&](double value, ImU32 colour, float thickness) {
        const float x = low.x + size.x * float((value - histogram.low) / range);
        if (x >= low.x && x <= high.x) draw.AddLine(ImVec2(x, low.y), ImVec2(x, high.y), colour, thickness);
    };
    if (runner_up) line(*runner_up, IM_COL32(255, 176, 32, 110), 1);
    if (iso) line(*iso, IM_COL32(255, 176, 32, 255), 2);
    if (!ImGui::IsItemActive()) return std::nullopt;
    return histogram.low + range * double((ImGui::GetIO().MousePos.x - low.x) / size.x);
}

}  // namespace bonemill
