#include "render_client/hand/controls/help_rows.h"

#include <span>
#include <string>
#include <utility>

#include "render_client/hand/controls/key_table.h"

namespace bonemill {
namespace {

// This is what ToolHold and ViewerControls make of the mouse.
const HudRow kMouseWithTool[] = {
    {"Mouse", "moves the tool"},         {"Left drag", "mill"},
    {"Shift+left drag", "add material"}, {"Right drag", "turn the tool"},
    {"Wheel", "tool deeper, nearer"},    {"Middle drag", "orbit, with Shift pan"}};

// This is what ViewerControls makes of the mouse.
const HudRow kMouse[] = {{"Left drag", "orbit"},
                         {"Right drag", "pan, as Shift+left drag"},
                         {"Wheel", "zoom"},
                         {"Double click", "orbit around that point"},
                         {"Ctrl+left drag", "point (instructor)"},
                         {"Ctrl+Shift+left drag", "draw on the bone"}};

// This is what PaneMouse makes of it.
const HudRow kMouseOverSlices[] = {{"Wheel", "scroll"},
                                   {"Left drag", "window, level"},
                                   {"Right drag", "zoom"},
                                   {"Double click", "as at the start"}};

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

bool isOfUse(const KeyBinding& binding, HelpFor whom, bool has_lesson) {
    const bool begins_hold = binding.action == Action::kHoldTool;
    if (binding.is_of_replay) return whom == HelpFor::kReplay;
    if (binding.is_of_lesson) return has_lesson;
    return !binding.is_of_hold || whom == HelpFor::kHolding || (begins_hold && whom == HelpFor::kMayHold);
}

constexpr struct {
    KeyGroup group;
    const char* title;
} kGroups[] = {{KeyGroup::kTool, "Tool in the mouse"},
               {KeyGroup::kView, "View"},
               {KeyGroup::kCuts, "Cut-planes, scan"},
               {KeyGroup::kSession, "Session"},
               {KeyGroup::kScreen, "Screen"}};

}  // namespace

std::vector<HelpGroup> helpGroups(HelpFor whom, bool has_lesson) {
    const std::span<const HudRow> mouse =
        whom == HelpFor::kHolding ? std::span<const HudRow>(kMouseWithTool) : std::span<const HudRow>(kMouse);
    std::vector<HelpGroup> groups{{"Mouse", {mouse.begin(), mouse.end()}}};
    if (whom == HelpFor::kReplay) groups[0].rows.push_back({"Right click", "when was this removed?"});
    for (const auto& [group, title] : kGroups) {
        std::vector<HudRow> rows;
        addKeys(keyTable(), rows, [&, g = group](const KeyBinding& binding) {
            return groupOf(binding.action) == g && isOfUse(binding, whom, has_lesson);
        });
        addKeys(signTable(), rows,
                [g = group](const SignBinding& binding) { return groupOf(binding.action) == g; });
        if (!rows.empty()) groups.push_back({title, std::move(rows)});
        if (group == KeyGroup::kCuts)
            groups.push_back(
                {"Mouse over a slice", {std::begin(kMouseOverSlices), std::end(kMouseOverSlices)}});
    }
    return groups;
}

std::vector<HudRow> startRows() {
    return {{keyLabelOf(Action::kHelp), "all keys"},
            {keyLabelOf(Action::kPanel), "control panel"},
            {keyLabelOf(Action::kDetails), "all figures"}};
}

std::vector<std::string> modeTexts(const ViewSettings& settings, bool is_drawing) {
    std::vector<std::string> modes;
    const auto add = [&](const std::string& text, Action action, const char* leave) {
        modes.push_back(text + " (" + keyLabelOf(action) + ": " + leave + ")");
    };
    if (is_drawing) add("Drawing", Action::kDraw, "off");
    if (settings.camera == CameraMode::kEndoscope) add("Endoscope", Action::kEndoscope, "back");
    if (settings.camera == CameraMode::kMicroscope) add("Microscope", Action::kMicroscope, "back");
    for (const auto& [axis, action] :
         {std::pair(0, Action::kCutX), std::pair(1, Action::kCutY), std::pair(2, Action::kCutZ)})
        if (settings.cuts[size_t(axis)].is_on) add("Cut " + keyLabelOf(action) + " on", action, "off");
    return modes;
}

std::vector<HudRow> hintRows() {
    const auto keys = [](std::initializer_list<Action> actions) {
        std::string text;
        for (const Action action : actions) text += (text.empty() ? "" : " ") + keyLabelOf(action);
        return text;
    };
    return {{"Mouse", "tool"},
            {"Left, " + keys({Action::kMill}), "mill"},
            {"Shift+left, " + keys({Action::kAddMaterial}), "add material"},
            {"Right, " + keys({Action::kTurnTool}), "turn the tool"},
            {"Wheel, " + keys({Action::kToolDeeper, Action::kToolNearer}), "deeper, nearer"},
            {"Middle", "orbit"},
            {keys({Action::kClutch}) + " held", "mouse for the camera"},
            {keys({Action::kHoldTool}), "let go"},
            {keys({Action::kPanel}), "control panel"},
            {keys({Action::kHelp}), "all keys"}};
}

}  // namespace bonemill
