#include "render_client/hand/controls/key_table.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

struct MouseRow {
    const char *label, *meaning;
};
// This is what ToolHold and ViewerControls make of the mouse.
constexpr MouseRow kMouseWithTool[] = {{trMark("Mouse"), trMark("moves the tool")},
                                       {trMark("Left drag"), trMark("mill")},
                                       {trMark("Shift+left drag"), trMark("add material")},
                                       {trMark("Right drag"), trMark("turn the tool")},
                                       {trMark("Wheel"), trMark("tool deeper, nearer")},
                                       {trMark("Middle drag"), trMark("orbit, with Shift pan")}};

// This is what ViewerControls makes of the mouse.
constexpr MouseRow kMouse[] = {{trMark("Left drag"), trMark("orbit")},
                               {trMark("Right drag"), trMark("pan, as Shift+left drag")},
                               {trMark("Wheel"), trMark("zoom")},
                               {trMark("Double click"), trMark("orbit around that point")},
                               {trMark("Ctrl+left drag"), trMark("point (instructor)")},
                               {trMark("Ctrl+Shift+left drag"), trMark("draw on the bone")}};

// This is what PaneMouse makes of it.
constexpr MouseRow kMouseOverSlices[] = {{trMark("Wheel"), trMark("scroll")},
                                         {trMark("Left drag"), trMark("window, level")},
                                         {trMark("Right drag"), trMark("zoom")},
                                         {trMark("Double click"), trMark("as at the start")}};

std::string shown(std::string_view text) {
    return tr(std::string(text).c_str());
}

// Keys that are more than a letter have names.
constexpr const char* kNamedKeys[] = {trMark("Shift"), trMark("Left"), trMark("Right"),
                                      trMark("Up"),    trMark("Down"), trMark("Space")};

// Returns "Skift+X" for "Shift+X".
std::string shownKey(std::string_view label) {
    const size_t plus = label.find('+', 1);
    if (plus != std::string_view::npos)
        return shownKey(label.substr(0, plus)) + "+" + shownKey(label.substr(plus + 1));
    const bool is_named = std::ranges::find(kNamedKeys, label) != std::end(kNamedKeys);
    return is_named ? shown(label) : std::string(label);
}

std::vector<HudRow> translated(std::span<const MouseRow> rows) {
    std::vector<HudRow> shown;
    for (const MouseRow& row : rows) shown.push_back({tr(row.label), tr(row.meaning)});
    return shown;
}

template <class Bindings, class Wanted>
void addKeys(const Bindings& bindings, std::vector<HudRow>& rows, Wanted&& is_wanted) {
    std::string last;
    for (const auto& binding : bindings) {
        if (!is_wanted(binding)) continue;
        const std::string meaning = meaningOf(binding);
        if (meaning == last) {
            rows.back().label += " " + shownKey(binding.label);
        } else {
            rows.push_back({shownKey(binding.label), meaning});
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
} kGroups[] = {{KeyGroup::kTool, trMark("Tool in the mouse")},
               {KeyGroup::kView, trMark("View")},
               {KeyGroup::kCuts, trMark("Cut-planes, scan")},
               {KeyGroup::kSession, trMark("Session")},
               {KeyGroup::kScreen, trMark("Screen")}};

constexpr KeyBinding kKeys[] = {
    {"R", keyOf('R'), false, Action::kFirstView, trMark("first view again")},
    {"C", keyOf('C'), false, Action::kResetBone, trMark("put the bone back")},
    {"F", keyOf('F'), false, Action::kForceArrow, trMark("force arrow")},
    {"X", keyOf('X'), false, Action::kCutX, trMark("cut-planes on, off")},
    {"Y", keyOf('Y'), false, Action::kCutY, trMark("cut-planes on, off")},
    {"Z", keyOf('Z'), false, Action::kCutZ, trMark("cut-planes on, off")},
    {"Shift+X", keyOf('X'), true, Action::kFlipX, trMark("cut away the other side")},
    {"Shift+Y", keyOf('Y'), true, Action::kFlipY, trMark("cut away the other side")},
    {"Shift+Z", keyOf('Z'), true, Action::kFlipZ, trMark("cut away the other side")},
    {"Shift+G", keyOf('G'), true, Action::kScanOnBone, trMark("scan on cuts, milled, materials")},
    {"Shift+S", keyOf('S'), true, Action::kSlices, trMark("slices through the scan")},
    {"T", keyOf('T'), false, Action::kTransparency, trMark("transparent bone")},
    {"Shift+T", keyOf('T'), true, Action::kStructures, trMark("structures: behind too, off")},
    {"Shift+D", keyOf('D'), true, Action::kThickness, trMark("thickness over structures")},
    {"S", keyOf('S'), false, Action::kStereo, trMark("stereo: side by side, red/cyan, off")},
    {"Q", keyOf('Q'), false, Action::kQuickDrawing, trMark("quick drawing")},
    {"E", keyOf('E'), false, Action::kEndoscope, trMark("endoscope")},
    {"Shift+E", keyOf('E'), true, Action::kMicroscope, trMark("microscope")},
    {"P", keyOf('P'), false, Action::kPauseMilling, trMark("pause milling, go on")},
    {"Shift+Left", Key::kLeft, true, Action::kReplayBack, trMark("replay: 5 s back, ahead"), true, false,
     false, true},
    {"Shift+Right", Key::kRight, true, Action::kReplayAhead, trMark("replay: 5 s back, ahead"), true, false,
     false, true},
    {"Shift+Down", Key::kDown, true, Action::kReplaySlower, trMark("replay: slower, faster"), true, false,
     false, true},
    {"Shift+Up", Key::kUp, true, Action::kReplayFaster, trMark("replay: slower, faster"), true, false, false,
     true},
    {"Shift+K", keyOf('K'), true, Action::kNextEvent, trMark("replay: next event"), true, false, false, true},
    {"Shift+U", keyOf('U'), true, Action::kPreviousEvent, trMark("replay: event before"), true, false, false,
     true},
    {"Shift+V", keyOf('V'), true, Action::kRemovalHere, trMark("replay: when was this removed?"), false,
     false, false, true},
    {"K", keyOf('K'), false, Action::kSaveCheckpoint, trMark("save a checkpoint")},
    {"U", keyOf('U'), false, Action::kLastCheckpoint, trMark("back to the last checkpoint")},
    {"N", keyOf('N'), false, Action::kNextTool, trMark("next tool")},
    {"D", keyOf('D'), false, Action::kResetDevice, trMark("reset the device after a stop")},
    {"Shift+C", keyOf('C'), true, Action::kAgain, trMark("again: whole bone, the scripted hand anew")},
    {"Shift+N", keyOf('N'), true, Action::kNextScene, trMark("next scene of the lesson"), false, false, true},
    {"Shift+P", keyOf('P'), true, Action::kTrainee, trMark("type the trainee's name; Enter starts"), false,
     false, true},
    {"Shift+F", keyOf('F'), true, Action::kStopAttempt, trMark("end the attempt"), false, false, true},
    {"0", keyOf('0'), false, Action::kAccuracyScene, trMark("accuracy of the scene file")},
    {"1", keyOf('1'), false, Action::kAccuracy1, trMark("accuracy")},
    {"2", keyOf('2'), false, Action::kAccuracy2, trMark("accuracy")},
    {"3", keyOf('3'), false, Action::kAccuracy3, trMark("accuracy")},
    {"4", keyOf('4'), false, Action::kAccuracy4, trMark("accuracy")},
    {"W", keyOf('W'), false, Action::kWatchers, trMark("who is watching")},
    {"M", keyOf('M'), false, Action::kPanel, trMark("control panel")},
    {"Tab", Key::kTab, false, Action::kHud, trMark("figures")},
    {"Shift+Tab", Key::kTab, true, Action::kDetails, trMark("all figures")},
    {"Shift+R", keyOf('R'), true, Action::kRemarks, trMark("notes and strokes")},
    {"L", keyOf('L'), false, Action::kPoint, trMark("point while held (instructor)")},
    {"Shift+L", keyOf('L'), true, Action::kDraw, trMark("draw on the bone with left drag")},
    {"Shift+M", keyOf('M'), true, Action::kNote, trMark("write a note at the mouse")},
    {"Left", Key::kLeft, false, Action::kOrbitLeft, trMark("orbit"), true},
    {"Right", Key::kRight, false, Action::kOrbitRight, trMark("orbit"), true},
    {"Up", Key::kUp, false, Action::kOrbitUp, trMark("orbit"), true},
    {"Down", Key::kDown, false, Action::kOrbitDown, trMark("orbit"), true},
    {"G", keyOf('G'), false, Action::kHoldTool, trMark("hold the tool, let it go"), false, true},
    {"B", keyOf('B'), false, Action::kMill, trMark("mill while held"), false, true},
    {"A", keyOf('A'), false, Action::kAddMaterial, trMark("add material while held"), false, true},
    {"V", keyOf('V'), false, Action::kTurnTool, trMark("turn the tool while held"), false, true},
    {"Space", Key::kSpace, false, Action::kClutch, trMark("mouse for the camera while held"), false, true},
    {"I", keyOf('I'), false, Action::kToolDeeper, trMark("tool deeper"), true, true},
    {"O", keyOf('O'), false, Action::kToolNearer, trMark("tool nearer"), true, true},
    {"J", keyOf('J'), false, Action::kLargerText, trMark("larger text"), true},
    {"Shift+J", keyOf('J'), true, Action::kSmallerText, trMark("smaller text"), true},
    {"H", keyOf('H'), false, Action::kHelp, trMark("this help")},
    {"F11", Key::kF11, false, Action::kFullScreen, trMark("full screen, window")},
    {"F12", Key::kF12, false, Action::kSavePicture, trMark("save the picture")},
    {"Esc", Key::kEscape, false, Action::kQuit, trMark("leave the help; quit")},
};

constexpr SignBinding kSigns[] = {
    {"[", U'[', Action::kCutLower, trMark("move the last cut-plane")},
    {"]", U']', Action::kCutHigher, trMark("move the last cut-plane")},
    {"+", U'+', Action::kZoomIn, trMark("zoom")},
    {"=", U'=', Action::kZoomIn, trMark("zoom")},  // + without shift on many keyboards
    {"-", U'-', Action::kZoomOut, trMark("zoom")},
};

}  // namespace

std::vector<HelpGroup> helpGroups(HelpFor whom, bool has_lesson) {
    const std::span<const MouseRow> mouse = whom == HelpFor::kHolding
                                                ? std::span<const MouseRow>(kMouseWithTool)
                                                : std::span<const MouseRow>(kMouse);
    std::vector<HelpGroup> groups{{tr("Mouse"), translated(mouse)}};
    if (whom == HelpFor::kReplay) groups[0].rows.push_back({tr("Right click"), tr("when was this removed?")});
    for (const auto& [group, title] : kGroups) {
        std::vector<HudRow> rows;
        addKeys(keyTable(), rows, [&, g = group](const KeyBinding& binding) {
            return groupOf(binding.action) == g && isOfUse(binding, whom, has_lesson);
        });
        addKeys(signTable(), rows,
                [g = group](const SignBinding& binding) { return groupOf(binding.action) == g; });
        if (!rows.empty()) groups.push_back({tr(title), std::move(rows)});
        if (group == KeyGroup::kCuts)
            groups.push_back({tr("Mouse over a slice"), translated(kMouseOverSlices)});
    }
    return groups;
}

std::vector<HudRow> startRows() {
    return {{keyLabelOf(Action::kHelp), tr("all keys")},
            {keyLabelOf(Action::kPanel), tr("control panel")},
            {keyLabelOf(Action::kDetails), tr("all figures")}};
}

std::vector<std::string> modeTexts(const ViewSettings& settings, bool is_drawing) {
    std::vector<std::string> modes;
    const auto add = [&](const std::string& text, Action action, const char* leave) {
        modes.push_back(text + " (" + keyLabelOf(action) + ": " + leave + ")");
    };
    if (is_drawing) add(tr("Drawing"), Action::kDraw, trIn("mode", "off"));
    if (settings.camera == CameraMode::kEndoscope)
        add(tr("Endoscope"), Action::kEndoscope, trIn("mode", "back"));
    if (settings.camera == CameraMode::kMicroscope)
        add(tr("Microscope"), Action::kMicroscope, trIn("mode", "back"));
    for (const auto& [axis, action] :
         {std::pair(0, Action::kCutX), std::pair(1, Action::kCutY), std::pair(2, Action::kCutZ)})
        if (settings.cuts[size_t(axis)].is_on)
            add(tr("Cut {1} on", {keyLabelOf(action)}), action, trIn("mode", "off"));
    return modes;
}

std::vector<HudRow> hintRows() {
    const auto keys = [](std::initializer_list<Action> actions) {
        std::string text;
        for (const Action action : actions) text += (text.empty() ? "" : " ") + keyLabelOf(action);
        return text;
    };
    return {{tr("Mouse"), tr("tool")},
            {tr("Left, {1}", {keys({Action::kMill})}), tr("mill")},
            {tr("Shift+left, {1}", {keys({Action::kAddMaterial})}), tr("add material")},
            {tr("Right, {1}", {keys({Action::kTurnTool})}), tr("turn the tool")},
            {tr("Wheel, {1}", {keys({Action::kToolDeeper, Action::kToolNearer})}), tr("deeper, nearer")},
            {tr("Middle"), tr("orbit")},
            {tr("{1} held", {keys({Action::kClutch})}), tr("mouse for the camera")},
            {keys({Action::kHoldTool}), tr("let go")},
            {keys({Action::kPanel}), tr("control panel")},
            {keys({Action::kHelp}), tr("all keys")}};
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
    return shown(binding.meaning) + (is_preset ? " " + std::string(accuracy) : "");
}

std::string meaningOf(const SignBinding& binding) {
    return shown(binding.meaning);
}

std::string keyLabelOf(Action action) {
    const auto binding = std::ranges::find(kKeys, action, &KeyBinding::action);
    return binding == std::end(kKeys) ? "" : shownKey(binding->label);
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
