// The table says which key does what, and what people call it: help page, panel and notices take both from
// here. It is for any thread.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud.h"

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
    kScanOnBone,
    kSlices,
    kTransparency,
    kStructures,
    kThickness,
    kStereo,
    kQuickDrawing,
    kEndoscope,
    kMicroscope,
    kPauseMilling,
    kReplayBack,  // this and those below are of use in a replay
    kReplayAhead,
    kReplaySlower,
    kReplayFaster,
    kPreviousEvent,
    kNextEvent,
    kRemovalHere,
    kSaveCheckpoint,
    kLastCheckpoint,
    kNextTool,
    kResetDevice,
    kAgain,
    kNextScene,  // this and the two below are of use in a lesson
    kTrainee,
    kStopAttempt,
    kAccuracyScene,
    kAccuracy1,
    kAccuracy2,
    kAccuracy3,
    kAccuracy4,
    kWatchers,
    kPanel,
    kHud,
    kDetails,
    kRemarks,
    kPoint,  // while the key is held
    kDraw,
    kNote,
    kOrbitLeft,
    kOrbitRight,
    kOrbitUp,
    kOrbitDown,
    kZoomIn,
    kZoomOut,
    kHoldTool,
    kMill,         // this and those below act while the mouse holds the tool; this one while the key is held
    kAddMaterial,  // while the key is held
    kTurnTool,     // while the key is held
    kClutch,       // while the key is held
    kToolDeeper,
    kToolNearer,
    kLargerText,
    kSmallerText,
    kHelp,
    kFullScreen,
    kSavePicture,
    kQuit,
};

// These belong together on the help page.
enum class KeyGroup { kView, kCuts, kSession, kTool, kScreen };
KeyGroup groupOf(Action action);

struct KeyBinding {
    std::string_view label;  // what people call the key: "Shift+X"
    Key key;
    bool with_shift;
    Action action;
    std::string_view meaning;   // neighbours with the same one share a row of the help page
    bool repeats = false;       // it acts again while the key is held
    bool is_of_hold = false;    // it is of use only where a mouse can hold the tool
    bool is_of_lesson = false;  // it is of use in a lesson
    bool is_of_replay = false;  // it is of use in a replay only
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

// This says which accuracy settings a digit key asks the server for, as the argument of Command.set_accuracy.
// The first one stands for what the scene file says.
inline constexpr std::string_view kAccuracyOfKey[] = {"scene", "thesis_2012", "fast", "balanced", "exact"};

// Returns the accuracy that an action asks for; empty for actions that ask for none.
std::string_view accuracyOf(Action action);

// Returns what the help page says of a key or a sign.
std::string meaningOf(const KeyBinding& binding);
std::string meaningOf(const SignBinding& binding);

// Returns what people call the key of an action that has one: the first in the table
// where several do the same.
std::string keyLabelOf(Action action);
// Returns the text with its key behind it: "Endoscope (E)".
std::string withKey(std::string_view text, Action action);

// Returns true when the event comes from the key of this action, whether it goes down or up.
bool isKeyOf(Action action, const KeyEvent& event);

// Returns the action of a key that goes down; a key that is held with Ctrl has none.
std::optional<Action> actionOf(const KeyEvent& event);
std::optional<Action> actionOf(const TextEvent& event);

// The help page says what mouse and keys do.
//
// The session's tool is none of the mouse's business, could be held by it, is held by it, or is a
// recording's.
enum class HelpFor { kLooking, kMayHold, kHolding, kReplay };

// Returns the mouse, then every key and sign of the table that is of use, by what they are for. Keys that do
// the same are one row, parted by spaces. Those of a lesson are among them where the server gives one.
std::vector<HelpGroup> helpGroups(HelpFor whom, bool has_lesson = false);

// Returns where help and panel are, for a hint over the first pictures.
std::vector<HudRow> startRows();

// Returns how the bone is looked at, and that the mouse draws, where that is not the usual way, each with the
// key that leaves it: "Cut Y on (Y: off)".
std::vector<std::string> modeTexts(const ViewSettings& settings, bool is_drawing = false);

// Returns in short what mouse and keys do to the tool that they hold, for a hint over the picture.
std::vector<HudRow> hintRows();

}  // namespace bonemill
