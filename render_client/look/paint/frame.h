// One picture shows this; the matrices, light and planes follow from it.
//
// The frames are W (world), V (volume), T (tool) and C (camera, see camera.h); the units are m and rad. They
// are plain values.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/geometry/pose.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/hud/device_lines.h"
#include "render_client/look/visual_effects/burr_effects.h"
#include "render_client/look/visual_effects/effect_input.h"
#include "render_client/look/visual_effects/surface_film.h"

namespace bonemill {

// Visual effects add this to one picture. They are plain values in the frame V, with units m and rad.
struct EffectPicture {
    Particles particles;           // dust, water
    std::optional<BurrTurn> turn;  // of the burr's flutes
    bool shows_blood = false, shows_water = false, shows_burns = false, shows_bruises = false;
    Eigen::Vector3f blood_colour = Eigen::Vector3f::Zero();  // linear
    SurfaceFilm* film = nullptr;  // where all that lies on the bone; its changes are taken

    bool showsFilm() const { return shows_blood || shows_water || shows_burns || shows_bruises; }
};

// The user wants the tool there; the line to it shows how hard the hand presses.
struct Pull {
    Eigen::Vector3d wish_W;
    double newtons;  // force on the hand
};

// The burr hangs in front of the bone: along the line of sight this is behind it, so far from its surface.
struct BurrGap {
    Eigen::Vector3d surface_W;
    double distance;  // m
};

// The room's light comes from the upper left, an instrument's from beside the eye: an endoscope's fades with
// distance, a microscope's comes along the line of sight from afar.
enum class LightRig { kRoom, kEndoscope, kMicroscope };

// A protected structure is drawn so.
struct StructureLook {
    uint32_t structure = 0;                            // 1 + its index in SceneInfo.materials
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();  // linear
    StructureMode mode = StructureMode::kThroughBone;
    float glow = 0;  // 0 to 1: the burr is near
    float rise = 0;  // m that its open surface has risen by, at most
    bool operator==(const StructureLook&) const = default;
};

// The burr is so near to a structure.
struct ClearanceLine {
    Eigen::Vector3d burr_W, structure_W;
    Eigen::Vector3f colour;
    double distance;  // m
};

// It was drawn on the bone, or is a dot, which has one point.
struct Stroke {
    std::vector<Eigen::Vector3f> points_W;
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();  // linear
};

struct FrameView {
    Camera camera;
    LightRig light = LightRig::kRoom;
    bool is_field_round = false;      // dark outside of a circle, as through an instrument
    bool has_depth_of_field = false;  // what is not at the camera's focus is blurred
    Pose X_WV;
    Eigen::AlignedBox3d bone_V;  // the bone at start; empty: nothing known yet
    double burr_radius = 0;
    std::optional<Pose> X_WT;              // the simulated tool (SPO)
    std::optional<Pose> X_WT_device;       // where the hand is; drawn when it differs visibly
    std::optional<Pose> X_WT_expert;       // where an expert's tool was
    std::optional<Eigen::Vector3d> f_T_W;  // the arrow's force, N
    std::optional<Pull> pull;              // of a mouse that holds the tool
    std::optional<BurrGap> gap;            // nothing: not shown
    bool shows_handpiece = true;
    BurrWork burr_work = BurrWork::kIdle;
    double burr_load = 0;  // 0 to 1
    CutPlanes cuts_W;
    std::optional<double> bone_opacity;  // empty: opaque
    std::vector<StructureLook> structures;
    Eigen::AlignedBox3d structures_V;  // around them
    std::optional<ClearanceLine> clearance;
    bool shows_thickness = false;
    std::vector<Eigen::Vector3d> pointers_W;
    bool shows_strokes = true;    // those of the renderer
    std::optional<Stroke> drawn;  // being drawn now
    Quality quality = Quality::kFull;
    const EffectPicture* effects = nullptr;  // null: the scene lists none
};

// Returns true when the device pose lies visibly off the simulated tool.
bool isGhostVisible(const Pose& X_WT, const Pose& X_WT_device);

struct KeyLight {
    Eigen::Vector3f direction;           // C, towards the light
    Eigen::Matrix4f shadow_from_camera;  // to the shadow map's -1 .. 1
    float shadow_texel;                  // m
    float reach;     // m from the eye to where an endoscope's light is as bright; 0: it is the room's
    float strength;  // against the room's, where it has no reach
    bool is_at_eye;  // what lies behind the eye casts no shadow
};

// The part of the tool that casts a shadow where there is no shadow map: the burr as a ball and a piece of
// the shaft behind it, in C.
struct ToolShadow {
    Eigen::Vector3f burr;
    Eigen::Vector3f shaft;  // the piece's end
    float burr_radius, shaft_radius;
    float reach;  // m along the light, beyond it there is none
    // Returns boxes that hold the tool and its shadow (C), one after the other away from the light.
    std::vector<Eigen::AlignedBox3f> boxes(const Eigen::Vector3f& key_direction) const;
};

// The tool's outline where it is not.
struct Ghost {
    Eigen::Matrix4f X_CT;
    Eigen::Vector3f colour;  // linear
};

struct Frame {
    Eigen::Matrix4f X_CV;
    Eigen::Matrix4f clip_from_camera;
    std::optional<Eigen::Matrix4f> X_CT;
    std::vector<Ghost> ghosts;
    KeyLight key;
    Eigen::Vector2f near_far;
    Eigen::Vector2f tangents;  // of half the field of view
    float shift;               // Camera::shift
    float bone_radius;         // m
    Eigen::AlignedBox3f bone_V;
    CutPlanes cuts_V, cuts_C;

    float field_radius;  // of the round field, in picture heights; 0: all of the picture is seen
    float focus;         // Camera::focus, m
    float blur_per_m;    // picture heights per m of depth away from the focus; 0: all is sharp
    bool has_shadow;
    std::optional<ToolShadow> tool_shadow;  // in quick quality
    Eigen::Matrix4f cull_from_V;            // bone outside of this clip space need not be drawn

    // tool_T is the tool's box, empty without one. The range must hold neededRange().
    static Frame make(const FrameView& view, const Eigen::AlignedBox3f& tool_T, double aspect,
                      const DepthRange& range);
    static DepthRange neededRange(const FrameView& view, const Eigen::AlignedBox3f& tool_T);

    // Sets the uniforms of the lighting and of the projection; the shadow map goes to unit 0.
    void setStrength(const Program& program) const;
    void setLight(const GlApi& gl, const Program& program, GLuint shadow_texture) const;
};

Eigen::Matrix4f matrixOf(const Pose& X_AB);

// Switches OpenGL's clip planes on for as long as it lives.
//
// It belongs to the thread of the context.
class ClipPlanes {
  public:
    ClipPlanes(const GlApi& gl, const CutPlanes& cuts) : gl_(gl), is_on_(cuts.is_on) {
        for (GLenum i = 0; i < is_on_.size(); ++i)
            if (is_on_[i]) gl_.Enable(GL_CLIP_DISTANCE0 + i);
    }
    ClipPlanes(const ClipPlanes&) = delete;
    ClipPlanes& operator=(const ClipPlanes&) = delete;
    ~ClipPlanes() {
        for (GLenum i = 0; i < is_on_.size(); ++i)
            if (is_on_[i]) gl_.Disable(GL_CLIP_DISTANCE0 + i);
    }

  private:
    const GlApi& gl_;
    std::array<bool, CutPlanes::kMax> is_on_;
};

// Sets the uniforms of the mesh shaders.
inline void setCutPlanes(const Program& program, const CutPlanes& cuts_model) {
    program.set("cut_planes[0]", cuts_model.planes[0]);
    program.set("cut_planes[1]", cuts_model.planes[1]);
    program.set("cut_planes[2]", cuts_model.planes[2]);
}

}  // namespace bonemill
