// The head-up display is made of these parts; how they are drawn is elsewhere. They are plain values,
// for any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

enum class HudTone { kPlain, kGood, kWarning, kAlarm };

struct HudRow {
    std::string label;
    std::string value;  // UTF-8, unit included
    HudTone tone = HudTone::kPlain;
};

// The user should notice this now, such as how a command ended.
struct HudNotice {
    std::string text;
    HudTone tone = HudTone::kPlain;
    float opacity = 1;
};

// The rows stand over the picture for a while: what the mouse does now.
struct HudHint {
    std::vector<HudRow> rows;
    float opacity = 1;
};

// Keys of the help page that belong together, and what they do.
struct HelpGroup {
    std::string title;
    std::vector<HudRow> rows;
};

// It stands in the middle of the picture while there is nothing else to see: facts, and sentences.
struct HudPage {
    std::string title;
    std::vector<HudRow> rows;
    std::vector<std::string> lines;
};

// The columns are axes as the camera sees them: x right, y up, z towards the eye.
struct OrientationAxes {
    Eigen::Matrix3f R_CA = Eigen::Matrix3f::Identity();
    bool are_patients = true;  // A is W, which is LPS; otherwise A is V
};

// Says which distance a colour stands for, from left to right.
struct HudLegend {
    std::string title;
    std::vector<std::array<float, 3>> colours;  // sRGB
    std::string low, high;                      // what the first and the last one stand for
};

// It says whether strangers can join the session: an open or a closed lock, or none where no other host can
// come at all.
enum class HudLock { kNone, kOpen, kClosed };

struct Hud {
    std::string title;  // empty: no figures
    HudLock lock = HudLock::kNone;
    std::string state;
    HudTone state_tone = HudTone::kPlain;
    std::vector<HudRow> rows;      // what matters to the task
    std::vector<HudRow> details;   // the rest; empty: folded
    std::vector<HudRow> watchers;  // empty: no list
    // How the bone is looked at, where that is not the usual way, and how to leave it.
    std::vector<std::string> modes;
    std::vector<HelpGroup> help;  // empty: no help page
    std::optional<HudLegend> legend;
    std::optional<HudPage> page;  // there are no figures then
    std::optional<HudHint> hint;
    std::optional<HudNotice> notice;
    std::vector<HudNotice> messages;  // what stands in the way, and what to do
    std::optional<HudNotice> alert;   // with a border around the picture
    std::optional<OrientationAxes> orientation;
};

// The name stands beside a point of the picture; x and y are pixels from the upper left.
struct HudLabel {
    float x = 0;
    float y = 0;
    std::string text;
    bool is_of_pointer = false;  // an instructor's
};

}  // namespace bonemill
