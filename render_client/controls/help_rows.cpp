#include "render_client/controls/help_rows.h"

#include <string>

#include "render_client/controls/key_table.h"

namespace bonemill {
namespace {

// This is what ToolHold and ViewerControls make of the mouse.
const HudRow kMouseWithTool[] = {
    {"Mouse", "moves the tool"},         {"Left drag", "mill"},
    {"Shift+left drag", "add material"}, {"Right drag", "turn the tool"},
    {"Wheel", "tool deeper, nearer"},    {"Middle drag", "orbit, with Shift pan"}};

// This is what ViewerControls makes of the mouse.
const HudRow kMouse[] = {{"Left drag", "orbit"},
                         {"Right drag, Shift+left drag", "pan"},
                         {"Wheel", "zoom"},
                         {"Double click", "orbit around that point"},
                         {"Ctrl+left drag", "point (instructor)"}};

template <class Bindings, class Wanted>
void addKeys(const Bindings& bindings, std::vector<HudRow>& rows, Wanted&& is_wanted) {
    std::string last;
    for (const auto& binding : bindings) {
        if (!is_wanted(binding)) continue;
        const std::string meaning = meaningOf(binding);
        if (meaning == last) {
            rows.back().label += " " + std::string(binding.label);
        } else {
            rows.push_back({std::string(binding.label), meaning});
        }
        last = meaning;
    }
}

}  // namespace

std::vector<HudRow> helpRows(HelpFor whom) {
    std::vector<HudRow> rows =
        whom == HelpFor::kHolding ? holdRows() : std::vector<HudRow>(std::begin(kMouse), std::end(kMouse));
    addKeys(keyTable(), rows, [&](const KeyBinding& binding) {
        const bool begins_hold = binding.action == Action::kHoldTool && whom == HelpFor::kMayHold;
        return begins_hold || !binding.is_of_hold;
    });
    addKeys(signTable(), rows, [](const SignBinding&) { return true; });
    return rows;
}

std::vector<HudRow> holdRows() {
    std::vector<HudRow> rows(std::begin(kMouseWithTool), std::end(kMouseWithTool));
    addKeys(keyTable(), rows, [](const KeyBinding& binding) { return binding.is_of_hold; });
    return rows;
}

}  // namespace bonemill
