#include "render_client/controls/key_table.h"

namespace bonemill {
namespace {

constexpr KeyBinding kKeys[] = {
    {"R", keyOf('R'), false, Action::kFirstView},
    {"C", keyOf('C'), false, Action::kResetBone},
    {"F", keyOf('F'), false, Action::kForceArrow},
    {"X", keyOf('X'), false, Action::kCutX},
    {"Y", keyOf('Y'), false, Action::kCutY},
    {"Z", keyOf('Z'), false, Action::kCutZ},
    {"Shift+X", keyOf('X'), true, Action::kFlipX},
    {"Shift+Y", keyOf('Y'), true, Action::kFlipY},
    {"Shift+Z", keyOf('Z'), true, Action::kFlipZ},
    {"T", keyOf('T'), false, Action::kTransparency},
    {"S", keyOf('S'), false, Action::kStereo},
    {"E", keyOf('E'), false, Action::kEndoscope},
    {"P", keyOf('P'), false, Action::kPauseMilling},
    {"K", keyOf('K'), false, Action::kSaveCheckpoint},
    {"U", keyOf('U'), false, Action::kLastCheckpoint},
    {"N", keyOf('N'), false, Action::kNextTool},
    {"0", keyOf('0'), false, Action::kAccuracyScene},
    {"1", keyOf('1'), false, Action::kAccuracy1},
    {"2", keyOf('2'), false, Action::kAccuracy2},
    {"3", keyOf('3'), false, Action::kAccuracy3},
    {"4", keyOf('4'), false, Action::kAccuracy4},
    {"W", keyOf('W'), false, Action::kWatchers},
    {"M", keyOf('M'), false, Action::kPanel},
    {"Tab", Key::kTab, false, Action::kHud},
    {"L", keyOf('L'), false, Action::kPoint},
    {"Left", Key::kLeft, false, Action::kOrbitLeft, true},
    {"Right", Key::kRight, false, Action::kOrbitRight, true},
    {"Up", Key::kUp, false, Action::kOrbitUp, true},
    {"Down", Key::kDown, false, Action::kOrbitDown, true},
    {"H", keyOf('H'), false, Action::kHelp},
    {"F12", Key::kF12, false, Action::kSavePicture},
    {"Esc", Key::kEscape, false, Action::kQuit},
};

constexpr SignBinding kSigns[] = {
    {"[", U'[', Action::kCutLower}, {"]", U']', Action::kCutHigher},
    {"+", U'+', Action::kZoomIn},   {"=", U'=', Action::kZoomIn},  // + without shift on many keyboards
    {"-", U'-', Action::kZoomOut},
};

}  // namespace

std::span<const KeyBinding> keyTable() {
    return kKeys;
}

std::span<const SignBinding> signTable() {
    return kSigns;
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
