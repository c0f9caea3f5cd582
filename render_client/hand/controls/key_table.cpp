#include "render_client/hand/controls/key_table.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <utility>

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

constexpr KeyBinding kKeys[] = {
    {"R", keyOf('R'), false, Action::kFirstView, "first view again"},
    {"C", keyOf('C'), false, Action::kResetBone, "put the bone back"},
    {"F", keyOf('F'), false, Action::kForceArrow, "force arrow"},
    {"X", keyOf('X'), false, Action::kCutX, "cut-planes on, off"},
    {"Y", keyOf('Y'), false, Action::kCutY, "cut-planes on, off"},
    {"Z", keyOf('Z'), false, Action::kCutZ, "cut-planes on, off"},
    {"Shift+X", keyOf('X'), true, Action::kFlipX, "cut away the other side"},
    {"Shift+Y", keyOf('Y'), true, Action::kFlipY, "cut away the other side"},
    {"Shift+Z", keyOf('Z'), true, Action::kFlipZ, "cut away the other side"},
    {"Shift+G", keyOf('G'), true, Action::kScanOnBone, "scan on cuts, milled, materials"},
    {"Shift+S", keyOf('S'), true, Action::kSlices, "slices through the scan"},
    {"T", keyOf('T'), false, Action::kTransparency, "transparent bone"},
    {"Shift+T", keyOf('T'), true, Action::kStructures, "structures: behind too, off"},
    {"Shift+D", keyOf('D'), true, Action::kThickness, "thickness over structures"},
    {"S", keyOf('S'), false, Action::kStereo, "stereo: side by side, red/cyan, off"},
    {"Q", keyOf('Q'), false, Action::kQuickDrawing, "quick drawing"},
    {"E", keyOf('E'), false, Action::kEndoscope, "endoscope"},
    {"Shift+E", keyOf('E'), true, Action::kMicroscope, "microscope"},
    {"P", keyOf('P'), false, Action::kPauseMilling, "pause milling, go on"},
    {"Shift+Left", Key::kLeft, true, Action::kReplayBack, "replay: 5 s back, ahead", true, false, false,
     true},
    {"Shift+Right", Key::kRight, true, Action::kReplayAhead, "replay: 5 s back, ahead", true, false, false,
     true},
    {"Shift+Down", Key::kDown, true, Action::kReplaySlower, "replay: slower, faster", true, false, false,
     true},
    {"Shift+Up", Key::kUp, true, Action::kReplayFaster, "replay: slower, faster", true, false, false, true},
    {"Shift+K", keyOf('K'), true, Action::kNextEvent, "replay: next event", true, false, false, true},
    {"Shift+U", keyOf('U'), true, Action::kPreviousEvent, "replay: event before", true, false, false, true},
    {"Shift+V", keyOf('V'), true, Action::kRemovalHere, "replay: when was this removed?", false, false, false,
     true},
    {"K", keyOf('K'), false, Action::kSaveCheckpoint, "save a checkpoint"},
    {"U", keyOf('U'), false, Action::kLastCheckpoint, "back to the last checkpoint"},
    {"N", keyOf('N'), false, Action::kNextTool, "next tool"},
    {"D", keyOf('D'), false, Action::kResetDevice, "reset the device after a stop"},
    {"Shift+C", keyOf('C'), true, Action::kAgain, "again: whole bone, the scripted hand anew"},
    {"Shift+N", keyOf('N'), true, Action::kNextScene, "next scene of the lesson", false, false, true},
    {"Shift+P", keyOf('P'), true, Action::kTrainee, "type the trainee's name; Enter starts", false, false,
     true},
    {"Shift+F", keyOf('F'), true, Action::kStopAttempt, "end the attempt", false, false, true},
    {"0", keyOf('0'), false, Action::kAccuracyScene, "accuracy of the scene file"},
    {"1", keyOf('1'), false, Action::kAccuracy1, "accuracy"},
    {"2", keyOf('2'), false, Action::kAccuracy2, "accuracy"},
    {"3", keyOf('3'), false, Action::kAccuracy3, "accuracy"},
    {"4", keyOf('4'), false, Action::kAccuracy4, "accuracy"},
    {"W", keyOf('W'), false, Action::kWatchers, "who is watching"},
    {"M", keyOf('M'), false, Action::kPanel, "control panel"},
    {"Tab", Key::kTab, false, Action::kHud, "figures"},
    {"Shift+Tab", Key::kTab, true, Action::kDetails, "all figures"},
    {"Shift+R", keyOf('R'), true, Action::kRemarks, "notes and strokes"},
    {"L", keyOf('L'), false, Action::kPoint, "point while held (instructor)"},
    {"Shift+L", keyOf('L'), true, Action::kDraw, "draw on the bone with left drag"},
    {"Shift+M", keyOf('M'), true, Action::kNote, "write a note at the mouse"},
    {"Left", Key::kLeft, false, Action::kOrbitLeft, "orbit", true},
    {"Right", Key::kRight, false, Action::kOrbitRight, "orbit", true},
    {"Up", Key::kUp, false, Action::kOrbitUp, "orbit", true},
    {"Down", Key::kDown, false, Action::kOrbitDown, "orbit", true},
    {"G", keyOf('G'), false, Action::kHoldTool, "hold the tool, let it go", false, true},
    {"B", keyOf('B'), false, Action::kMill, "mill while held", false, true},
    {"A", keyOf('A'), false, Action::kAddMaterial, "add material while held", false, true},
    {"V", keyOf('V'), false, Action::kTurnTool, "turn the tool while held", false, true},
    {"Space", Key::kSpace, false, Action::kClutch, "mouse for the camera while held", false, true},
    {"I", keyOf('I'), false, Action::kToolDeeper, "tool deeper", true, true},
    {"O", keyOf('O'), false, Action::kToolNearer, "tool nearer", true, true},
    {"J", keyOf('J'), false, Action::kLargerText, "larger text", true},
    {"Shift+J", keyOf('J'), true, Action::kSmallerText, "smaller text", true},
    {"H", keyOf('H'), false, Action::kHelp, "this help"},
    {"F11", Key::kF11, false, Action::kFullScreen, "full screen, window"},
    {"F12", Key::kF12, false, Action::kSavePicture, "save the picture"},
    {"Esc", Key::kEscape, false, Action::kQuit, "leave the help; quit"},
};

constexpr SignBinding kSigns[] = {
    {"[", U'[', Action::kCutLower, "move the last cut-plane"},
    {"]", U']', Action::kCutHigher, "move the last cut-plane"},
    {"+", U'+', Action::kZoomIn, "zoom"},
    {"=", U'=', Action::kZoomIn, "zoom"},  // + without shift on many keyboards
    {"-", U'-', Action::kZoomOut, "zoom"},
};

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

KeyGroup groupOf(Action action) {
    const auto lies = [action](Action first, Action last) { return action >= first && action <= last; };
    if (lies(Action::kCutX, Action::kSlices)) return KeyGroup::kCuts;
    if (lies(Action::kPauseMilling, Action::kAccuracy4) || action == Action::kResetBone ||
        lies(Action::kPoint, Action::kNote))
        return KeyGroup::kSession;
    if (lies(Action::kHoldTool, Action::kToolNearer)) return KeyGroup::kTool;
    if (lies(Action::kWatchers, Action::kRemarks) || lies(Action::kLargerText, Action::kQuit))
        return KeyGroup::kScreen;
    return KeyGroup::kView;
}

std::span<const KeyBinding> keyTable() {
    return kKeys;
}

std::span<const SignBinding> signTable() {
    return kSigns;
}

std::string_view accuracyOf(Action action) {
    const size_t first = size_t(Action::kAccuracyScene), n = size_t(action) - first;
    return size_t(action) >= first && n < std::size(kAccuracyOfKey) ? kAccuracyOfKey[n] : std::string_view();
}

std::string meaningOf(const KeyBinding& binding) {
    const std::string_view accuracy = accuracyOf(binding.action);
    const bool is_preset = !accuracy.empty() && binding.action != Action::kAccuracyScene;
    return std::string(binding.meaning) + (is_preset ? " " + std::string(accuracy) : "");
}

std::string meaningOf(const SignBinding& binding) {
    return std::string(binding.meaning);
}

std::string keyLabelOf(Action action) {
    const auto binding = std::ranges::find(kKeys, action, &KeyBinding::action);
    return binding == std::end(kKeys) ? "" : std::string(binding->label);
}

std::string withKey(std::string_view text, Action action) {
    return std::string(text) + " (" + keyLabelOf(action) + ")";
}

bool isKeyOf(Action action, const KeyEvent& event) {
    return std::ranges::any_of(kKeys, [&](const KeyBinding& binding) {
        return binding.action == action && binding.key == event.key;
    });
}

std::optional<Action> actionOf(const KeyEvent& event) {
    if (!event.is_down || event.held.control) return std::nullopt;
    for (const KeyBinding& binding : kKeys)
        if (binding.key == event.key && binding.with_shift == event.held.shift &&
            (binding.repeats || !event.is_repeat))
            return binding.action;
    return std::nullopt;
}

std::optional<Action> actionOf(const TextEvent& event) {
    for (const SignBinding& binding : kSigns)
        if (binding.sign == event.sign) return binding.action;
    return std::nullopt;
}

}  // namespace bonemill
