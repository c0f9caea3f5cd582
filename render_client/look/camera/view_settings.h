// The user of a viewer has chosen to see this. They are plain values, for any thread.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

namespace bonemill {

enum class CameraMode { kOrbit, kEndoscope, kMicroscope };
// kQuick leaves out shadow and antialiasing, and draws only what changed while the view rests. It is meant
// for OpenGL in software.
enum class Quality { kFull, kQuick };
enum class StereoMode { kOff, kSideBySide, kAnaglyph };

// Hides the bone on one side of a plane across a world axis, and shows the cut.
struct CutPlane {
    bool is_on = false;
    double position = 0.5;    // from the low (0) to the high end (1) of the bone's box along the axis, W
    bool is_flipped = false;  // false: the side above is hidden
};

// The effects stand in the order of the scene's message Effects.
enum class ViewerEffect : uint8_t {
    kBoneDust,
    kBleeding,
    kIrrigation,
    kBurrSpin,
    kMillingSound,
    kBrowning,
    kBruising,
    kPulse
};
constexpr size_t kViewerEffects = size_t(ViewerEffect::kPulse) + 1;

// Grey goes from black at level - width / 2 to white at level + width / 2, in the scan's values (HU of a CT).
struct GreyWindow {
    double width = 1;
    double level = 0;
    bool operator==(const GreyWindow&) const = default;
};

// This shows the scan's grey values instead of the bone's colour, or cuts in the colours of the materials.
enum class CtShown { kNowhere, kOnCuts, kOnCutsAndMilled, kMaterialsOnCuts };

struct SliceSettings {
    bool are_shown = false;  // the three panes
    // Each pane, across W's x (sagittal), y (coronal), z (axial), shows the slice there (m, W); empty: the
    // one through the tool.
    std::array<std::optional<double>, 3> positions;
    double zoom = 1;  // of the panes; 1 shows the whole scan
    static constexpr double kMaxZoom = 16;
    std::optional<GreyWindow> window;  // empty: what suits the scan
    CtShown ct = CtShown::kOnCuts;
};

// How a protected structure is seen; the places of ViewSettings::structures are 1 + its index in
// SceneInfo.materials. Bone hides what lies behind it, but where it is thin (shineThrough()).
enum class StructureMode : uint8_t { kExposedOnly, kThroughBone, kOff };
constexpr size_t kMaxStructures = 256;

struct ViewSettings {
    static constexpr double kDefaultOpacity = 0.35;

    CameraMode camera = CameraMode::kOrbit;
    bool has_depth_of_field = false;  // of the microscope
    Quality quality = Quality::kFull;
    bool picks_quality = false;  // the viewer picks it, by the time that pictures take
    StereoMode stereo = StereoMode::kOff;
    bool is_transparent = false;
    double opacity = kDefaultOpacity;  // of the transparent bone
    std::array<CutPlane, 3> cuts;      // across W's x (sagittal), y (coronal), z (axial)
    SliceSettings slices;
    // Part of the scan may be seen, in slices or on cuts or milled bone.
    bool showsScan() const {
        const bool is_cut = cuts[0].is_on || cuts[1].is_on || cuts[2].is_on;
        return slices.are_shown || slices.ct == CtShown::kOnCutsAndMilled ||
               (slices.ct != CtShown::kNowhere && is_cut);
    }
    bool show_force = true;
    bool show_handpiece = true;
    // The places are those of ViewerEffect; only those that the scene lists are seen.
    std::array<bool, kViewerEffects> hides_effects{};
    bool shows(ViewerEffect effect) const { return !hides_effects[size_t(effect)]; }
    std::array<StructureMode, kMaxStructures> structures{};
    bool show_clearance = true;   // the line from the burr to the nearest structure
    bool show_thickness = false;  // bone has the colour of its distance to the next structure
    bool show_remarks = true;     // notes and strokes of people
    bool show_hud = true;
    bool show_details = false;  // with the figures that matter to the task, all others
    bool show_watchers = false;
    bool show_help = false;
    bool is_for_colour_blind = false;  // the palette
    double text_scale = 1;             // the user's own factor, kMinText to kMaxText
    static constexpr double kMinText = 0.5, kMaxText = 4;

    // Forgets what was chosen of one scene's bone, scan and structures and means something else in the next
    // one.
    void forgetScene() {
        cuts = {};
        structures.fill(structures[0]);
        slices.positions = {};
        slices.zoom = 1;
        slices.window.reset();
    }
};

// The view's cut-planes are half-spaces: a point p is shown when n·p + d >= 0 for all of them.
//
// Each plane is (n, d) with a unit normal n towards the side that is shown, m. One that is off hides nothing.
struct CutPlanes {
    static constexpr int kMax = 3;
    std::array<Eigen::Vector4f, kMax> planes = {Eigen::Vector4f::UnitW(), Eigen::Vector4f::UnitW(),
                                                Eigen::Vector4f::UnitW()};
    std::array<bool, kMax> is_on{};

    bool any() const { return is_on[0] || is_on[1] || is_on[2]; }
};

// Returns the planes in W. The positions count within the bone's box in W; an empty box has no cuts.
CutPlanes cutPlanes(const std::array<CutPlane, CutPlanes::kMax>& cuts, const Eigen::AlignedBox3d& bone_W);

// Returns the same planes in frame A, with the rigid X_AB.
CutPlanes transformed(const CutPlanes& cuts_B, const Eigen::Matrix4f& X_AB);

}  // namespace bonemill
