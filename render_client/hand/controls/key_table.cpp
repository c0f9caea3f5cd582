#include "render_client/hand/controls/key_table.h"

#include <algorithm>
#include <iterator>

namespace bonemill {
namespace {

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
