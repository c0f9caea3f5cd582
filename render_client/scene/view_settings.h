// What the user of a viewer has chosen to see. Plain values; any thread.
#pragma once

#include <array>
#include <cstdint>

namespace bonemill {

enum class CameraMode { kOrbit, kEndoscope };
// kQuick: without shadow and antialiasing; while the view rests, only what changed is drawn anew. For
// software OpenGL.
enum class Quality { kFull, kQuick };
enum class StereoMode { kOff, kSideBySide, kAnaglyph };

// Hides the bone on one side of a plane across a world axis, and shows the cut.
struct CutPlane {
    bool is_on = false;
    double position = 0.5;    // from the low (0) to the high end (1) of the bone's box along the axis, W
    bool is_flipped = false;  // false: the side above is hidden
};

struct ViewSettings {
    static constexpr double kDefaultOpacity = 0.35;

    CameraMode camera = CameraMode::kOrbit;
    Quality quality = Quality::kFull;
    StereoMode stereo = StereoMode::kOff;
    bool is_transparent = false;
    double opacity = kDefaultOpacity;  // of the transparent bone
    std::array<CutPlane, 3> cuts;      // across W's x (sagittal), y (coronal), z (axial)
    bool show_force = true;
    bool show_hud = true;
    bool show_watchers = true;
    bool show_help = false;
};

}  // namespace bonemill
