// It is everything that a viewer shows, fed with plain updates and drawn into any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. The picture depends only on
// the newest updates, the view and the size, not on the order in which the updates came.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/node_mesh.h"
#include "proto/topics.pb.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/hud/conditions.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/hud_lines.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/paint/frame_passes.h"
#include "render_client/look/paint/hud_painter.h"
#include "render_client/look/paint/scene_renderer.h"
#include "render_client/look/render_scene/bone_marks.h"
#include "render_client/look/render_scene/ct_show.h"
#include "render_client/look/visual_effects/visual_effects.h"

namespace bonemill {

// Returns where an instructor points (W); nothing for others.
std::optional<Eigen::Vector3d> pointerPlace(const topics::Viewer& watcher);

class RenderScene {
  public:
    // With has_effects false, the effects that scenes list are not made. Throws GlError
    // (driver) or UserError (font).
    explicit RenderScene(const GlApi& gl, bool has_effects = true);

    // Replaces the node's mesh; an empty one removes it. Throws std::invalid_argument on a mesh that
    // contradicts itself.
    void setNode(const NodeMesh& mesh);
    void clearNodes();

    // Replaces the protected structure that the mesh's leaf names; the distance is in m. Throws
    // std::invalid_argument on a mesh that contradicts itself.
    void setStructure(const NodeMesh& mesh, double warning_distance);
    void clearStructures();

    // Takes what people wrote and drew, by place.
    void setRemarks(const std::map<uint32_t, topics::Remark>& remarks);
    // Takes the stroke that the user is drawing; without points there is none.
    void setDrawn(Stroke stroke) { drawn_ = std::move(stroke); }

    // The first scene, and every scene of another name, resets the view; a newer revision of the same one
    // brings another tool. An older revision of the same epoch changes nothing. Throws std::invalid_argument
    // on a bad message.
    void setSceneInfo(const topics::SceneInfo& info);
    // The state may be the same one again. What its effects tell of events stays on the screen for a while;
    // visual effects take what was removed from each new one.
    void setToolState(const topics::ToolState& tool);
    void setStatus(const topics::Status& status);
    void setConnection(Connection connection) { hud_input_.connection = connection; }
    // Takes what a second server of the session calls its scene; nullopt where there is none.
    void setOtherServer(std::optional<std::string> scene) { hud_input_.other_server = std::move(scene); }
    // The notice is shown until it is replaced; nullopt takes it away.
    void setNotice(std::optional<HudNotice> notice) { hud_input_.notice = std::move(notice); }

    // Takes how the bone is looked at, where that is not the usual way, and how to leave it.
    void setModes(std::vector<std::string> modes) { hud_input_.modes = std::move(modes); }

    // Takes where the user's mouse wants the tool point (W); nullopt while it holds no tool.
    void setPull(const std::optional<Eigen::Vector3d>& wish_W) { pull_W_ = wish_W; }
    // Takes what stands over the picture of what the mouse does; nullopt takes it away.
    void setHint(std::optional<HudHint> hint) { hud_input_.hint = std::move(hint); }

    // Takes the help page: keys and what they do. There is no page before the first call.
    void setHelp(std::vector<HelpGroup> groups) { hud_input_.help = std::move(groups); }
    // Takes which server the viewer waits for, to be said while there was none yet.
    void setSought(ServerSought sought) { hud_input_.sought = std::move(sought); }

    // Takes the pictures per second of this viewer over the last second; 0 means not known.
    void setFrameRate(double frame_rate_hz) { hud_input_.frame_rate_hz = frame_rate_hz; }

    OrbitCamera& camera() { return camera_; }
    // This wish goes before what the scene file asks of the first view.
    void setViewWish(const ViewWish& wish);
    // Goes back to the first view, at the next draw().
    void resetView() { view_pending_ = true; }
    ViewSettings& settings() { return settings_; }
    // Takes who is watching, and where instructors point.
    void setWatchers(std::vector<topics::Viewer> watchers) { hud_input_.watchers = std::move(watchers); }

    // Returns the point of bone or tool (W, m) under that pixel of the last picture, counted from the upper
    // left: of transparent bone the outer surface, of cut bone also the cut. There is none over the
    // background, outside the picture, in stereo and before the first picture.
    std::optional<Eigen::Vector3d> pick(int x, int y) const;

    // Takes the pixel (from the upper left) where the user's mouse is: what structure is seen there is told
    // by name. nullopt takes it away.
    void setMouse(const std::optional<std::pair<int, int>>& at) { mouse_ = at; }
    // Returns the name of the structure under that pixel of the last picture; empty where pick() finds no
    // place, and none is seen.
    std::string structureAt(int x, int y) const;

    // Lets the visual effects go on by this time (s).
    void advance(double seconds) {
        if (effects_) effects_->advance(seconds);
    }
    // It is null while the scene lists none, or nothing is known of it yet.
    const VisualEffects* effects() const { return effects_.get(); }

    // Returns the camera of the next picture.
    Camera viewCamera() const { return makeView().camera; }
    // Returns the box (W) of the bone as it was at the start; it is empty while nothing is known.
    Eigen::AlignedBox3d bone_W() const;
    // Returns that of the tool in use, m; 0 while nothing is known.
    double burrRadius() const { return hud_input_.info ? hud_input_.info->burr_radius_m() : 0; }
    // Returns where the simulated tool is, if a tool state has told, and with how many contacts.
    std::optional<Pose> toolPose() const;
    uint32_t contacts() const { return hud_input_.tool ? hud_input_.tool->contacts() : 0; }
    // The camera of the next picture rides on the tool.
    bool followsTool() const;
    // Returns where the device's hand is, if a tool state has told.
    std::optional<Pose> devicePose() const;

    // Takes the scan's densities, and says which of them are wanted. It has a scene's grid or none.
    DensityStore& densities() { return ct_.store(); }
    // Returns the slices that the last picture showed beside the bone; nothing while there are none.
    std::optional<SeenPanes> seenPanes() const { return ct_.seenPanes(); }
    // Returns how many columns of a picture of this size (pixels) the bone has; panes stand at the right of
    // it.
    int viewWidth(int width, int height) const { return width - paneColumns(settings_, width, height); }

    // With those of a bone beside the first.
    size_t nodeCount() const { return nodes_.nodeCount() + other_nodes_.nodeCount(); }
    size_t triangleCount() const { return nodes_.triangleCount() + other_nodes_.triangleCount(); }
    size_t trianglesDrawn() const { return renderer_.trianglesDrawn(); }
    const UploadCount& uploads() const { return nodes_.uploads(); }
    // Returns the faults of the session that pictures have shown.
    std::vector<FaultEntry> faults() const { return faults_.faults(); }
    bool hasSceneInfo() const { return hud_input_.info.has_value(); }

    // The next draw() draws everything, in quick quality too: the same picture, only slower.
    void drawWholeNext() { renderer_.drawWholeNext(); }

    // Draws into `target`, a framebuffer of this size (pixels). ui_scale 1 suits 800 pixels of height.
    void draw(int width, int height, float ui_scale, GLuint target = 0);

  private:
    void applyFirstView(double aspect);
    void lookForFaults();
    void colourBone();
    void makeEffects(const topics::SceneInfo& info);
    void takeEffectInput();
    const EffectPicture* effectPicture();
    FrameView makeView() const;
    void lookThroughMicroscope(FrameView& view) const;
    void showTool(FrameView& view) const;
    void updateCt(int width, int height);
    void paintPanes(int width, int height, float ui_scale, GLuint target);
    void drawEye(FrameView view, const Camera& camera, const PictureArea& area, float ui_scale,
                 GLuint target);
    void drawSideBySide(const FrameView& view, int width, int height, float ui_scale, GLuint target);
    // A replay is compared with another attempt, whose bone is at the right.
    bool showsBeside() const;
    bool isOfOther(uint32_t leaf) const;
    FrameView otherView(FrameView view);
    void drawBeside(const FrameView& view, int width, int height, float ui_scale, GLuint target);
    void drawAnaglyph(const FrameView& view, int width, int height, float ui_scale, GLuint target);
    // W is the patient's LPS, as far as is known.
    bool hasPatientAxes() const { return !hud_input_.info || !hud_input_.info->lacks_patient_axes(); }
    OrientationAxes orientationOf(const Camera& camera) const;
    void paintHud(const Camera& camera, const PictureArea& area, float ui_scale);
    void prepareNearStructures(const FrameView& view);
    void nameMouse(const PictureArea& area, std::vector<HudLabel>& labels) const;
    void paintNames(const FrameView& view, const PictureArea& area, float ui_scale);

    const bool has_effects_;
    NodeStore nodes_, other_nodes_;  // the latter of SceneInfo.other_first_leaf on
    ToolMesh tool_;
    SceneRenderer renderer_;
    Anaglyph anaglyph_;
    HudPainter hud_painter_;
    CtShow ct_;
    HudInput hud_input_;
    bool awaits_info_ = true;  // nothing has told the scene of this run of the server yet
    // These came before the scene info said whether effects need them.
    std::map<uint32_t, NodeMesh> early_nodes_;
    std::unique_ptr<VisualEffects> effects_;
    EffectPicture effect_picture_;
    EffectPicture no_effects_;                   // as a scene that lists some shows where there are none
    std::string effects_text_;                   // the message they were made from
    std::pair<uint64_t, uint64_t> taken_state_;  // epoch and tick of the tool state that effects took last
    Pose X_WV_;
    Eigen::AlignedBox3d bone_V_;
    OrbitCamera camera_;
    ViewWish view_wish_;
    bool view_pending_ = true;
    ViewSettings settings_;
    bool can_pick_ = false;
    std::optional<Eigen::Vector3d> pull_W_;
    EventLatch events_;
    FaultList faults_;
    StructureView structures_;
    RemarkView remarks_;
    Stroke drawn_;                                                        // now
    std::optional<std::map<uint32_t, Eigen::Vector3f>> near_structures_;  // drawn, with their colours
    std::optional<std::pair<int, int>> mouse_;
    FrameView last_view_;  // of the last picture without stereo
    std::vector<Eigen::Vector4f> vertex_colours_;
    bool was_for_colour_blind_ = false;  // the last picture
    const GlApi& gl_;
};

}  // namespace bonemill
