// Which key does what, and how the help page says it: the one place. Any thread.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "render_client/controls/window_event.h"

namespace bonemill {

enum class Action {
    kFirstView,
    kResetBone,
    kForceArrow,
    kCutX,
    kCutY,
    kCutZ,
    kFlipX,
    kFlipY,
    kFlipZ,
    kCutLower,
    kCutHigher,
    kTransparency,
    kStereo,
    kQuickDrawing,
    kEndoscope,
    kPauseMilling,
    kSaveCheckpoint,
    kLastCheckpoint,
    kNextTool,
    kAccuracyScene,
    kAccuracy1,
    kAccuracy2,
    kAccuracy3,
    kAccuracy4,
    kWatchers,
    kPanel,
    kHud,
    kPoint,  // while the key is held
    kOrbitLeft,
    kOrbitRight,
    kOrbitUp,
    kOrbitDown,
    kZoomIn,
    kZoomOut,
    kHelp,
    kSavePicture,
    kQuit,
};

struct KeyBinding {
    std::string_view label;  // what people call it: "Shift+X"
    Key key;
    bool with_shift;
    Action action;
    std::string_view meaning;  // for the help page; neighbours with the same one share a row
    bool repeats = false;      // acts again while the key is held
};

// Signs such as [ and + are bound by the text they make: where they lie differs from layout to layout.
struct SignBinding {
    std::string_view label;
    char32_t sign;
    Action action;
    std::string_view meaning;
};

std::span<const KeyBinding> keyTable();
std::span<const SignBinding> signTable();

// Of a key going down; also those held with Ctrl have none.
std::optional<Action> actionOf(const KeyEvent& event);
std::optional<Action> actionOf(const TextEvent& event);

}  // namespace bonemill
