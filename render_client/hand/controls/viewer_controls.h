// Keys, mouse and panel do this to a viewer. Each action means the same, whoever asked for it.
//
// View settings and camera are changed at once; what others have to do is left in the wishes. It belongs to
// the render thread. Never throws.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "render_client/hand/controls/key_table.h"
#include "render_client/hand/controls/mouse_modes.h"
#include "render_client/hand/controls/session_view.h"
#include "render_client/hand/controls/tool_hold.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// The user asked for this, and the owner of the viewer has to carry it out.
struct Wishes {
    std::vector<topics::Command> commands;
    bool reset_view = false;
    bool hold_tool = false;               // with the mouse, from where it may begin
    std::optional<PixelPoint> centre_at;  // orbit around the surface there from now on
    std::optional<HudNotice> notice;      // why something was not done
    bool full_screen = false;             // or, from there, the window of before
    bool save_picture = false;
    bool save_attempts = false;                 // of the lesson, as CSV
    bool make_clip = false;                     // of the moment of the replay
    std::vector<std::string> what_if;           // as `bonemill what-if` takes it, from the replay's moment on
    std::string replay_of;                      // an attempt's results, to be seen again; empty: none
    std::string invite;                         // this person; empty: nobody
    std::string invite_as;                      // the person's role
    std::string copy;                           // into the clipboard; empty: nothing
    std::string open_file;                      // by the desktop's program for it; empty: none
    std::string language;                       // to be spoken from now on; empty: as before
    bool type_trainee = false;                  // in the panel
    bool next_trainee = false;                  // in the panel: another name
    bool write_note = false;                    // in the panel
    std::optional<PixelPoint> note_at;          // it belongs to the bone there
    std::optional<Eigen::Vector3d> note_place;  // which is this place (W): the owner's to say
    std::string asked;                          // a question was put to the user, for the log
    std::optional<PixelPoint> removal_at;       // when was the bone there removed? (in a replay)
    std::optional<uint32_t> session;            // to be joined, of those that are offered
    bool quit = false;
};

// The bone is looked at from this side of the patient.
enum class Side { kFront, kBack, kLeft, kRight, kTop, kBottom };

class ViewerControls {
  public:
    // Settings and camera must outlive the controls.
    ViewerControls(ViewSettings& settings, OrbitCamera& camera) : settings_(settings), camera_(camera) {}

    // Takes an event of the window, over a picture of this height (pixels).
    void handle(const WindowEvent& event, int picture_height, const SessionView& session, Wishes& wishes);
    // The mouse moved over the panel, which means nobody here.
    void passOver(const MouseMoveEvent& event);
    void act(Action action, const SessionView& session, Wishes& wishes);
    // Asks the server for it.
    void request(const topics::Command& command, const SessionView& session, Wishes& wishes) {
        want({Deed::Kind::kCommand, command}, session, wishes);
    }
    // Does it, or first asks the user where something would be lost. The question stands until it is
    // answered; to want the same once more means yes. A second start of an attempt within kStartTime is none:
    // a double click.
    void want(const Deed& deed, const SessionView& session, Wishes& wishes);
    static constexpr double kStartTime = 2;  // s

    // Returns the question that stands.
    std::optional<Question> question(const SessionView& session) const;
    enum class Answer { kYes, kNo, kSaveFirst };
    void answer(Answer answer, const SessionView& session, Wishes& wishes);
    // Drops a question about what would be lost no more.
    void dropIdleQuestion(const SessionView& session);
    // Turns around the target; the distance stays.
    void lookFrom(Side side);

    void showEffect(ViewerEffect effect, bool is_shown) {
        settings_.hides_effects[size_t(effect)] = !is_shown;
    }
    void showScan(CtShown where) { settings_.slices.ct = where; }
    void showHandpiece(bool is_shown) { settings_.show_handpiece = is_shown; }
    void setDepthOfField(bool is_on) { settings_.has_depth_of_field = is_on; }
    void setStereo(StereoMode mode) { settings_.stereo = mode; }
    void showForColourBlind(bool is_wanted) { settings_.is_for_colour_blind = is_wanted; }
    void setTextScale(double factor) { settings_.text_scale = factor; }
    void pickQuality(bool is_wanted) { settings_.picks_quality = is_wanted; }
    // Lets this structure be seen so; the number is 1 + its index in SceneInfo.materials.
    void showStructure(size_t structure, StructureMode mode) { settings_.structures.at(structure) = mode; }
    void showClearance(bool is_shown) { settings_.show_clearance = is_shown; }
    // Makes bone transparent, of this opacity from 0 to 1.
    void setOpacity(double opacity);
    // Moves the cut to this place, from the low (0) to the high end (1) of the bone's box along W's axis (0
    // to 2). The cut is switched on and becomes the one that [ and ] move.
    void moveCutTo(size_t axis, double position);

    const ViewSettings& settings() const { return settings_; }
    const OrbitCamera& camera() const { return camera_; }
    // The owner begins the hold, and tells it which picture the user sees.
    ToolHold& toolHold() { return hold_; }
    // The owner tells it which panes the user sees.
    PaneMouse& paneMouse() { return pane_mouse_; }
    const ToolHold& toolHold() const { return hold_; }
    // The owner tells it what is under the mouse, and gives its orders.
    StrokePen& pen() { return pen_; }
    // Left drags draw on the bone.
    bool isDrawing() const { return is_drawing_; }
    bool isPanelOpen() const { return is_panel_open_; }
    void openPanel(bool is_open) { is_panel_open_ = is_open; }
    // Returns where the user points with the laser now.
    std::optional<PixelPoint> pointing() const;
    // Returns where the mouse rests or moves, also with the tool, while it drags and mills nothing.
    std::optional<PixelPoint> hovering() const;

  private:
    enum class Drag { kNone, kOrbit, kPan, kPoint, kDraw };

    void onKey(const KeyEvent& event, const SessionView& session, Wishes& wishes);
    void onButton(const MouseButtonEvent& event, const SessionView& session, Wishes& wishes);
    void onMove(const MouseMoveEvent& event, int picture_height);
    void onDoubleClick(const MouseButtonEvent& event, Wishes& wishes);
    bool isSecondStart(const Deed& deed, const SessionView& session) const;
    void carryOut(const Deed& deed, const SessionView& session, Wishes& wishes);
    void changeView(Action action);
    void switchDetails();
    void scaleText(double factor);
    void switchCamera(CameraMode mode);
    void switchCut(size_t axis);
    void flipCut(size_t axis);
    void moveCut(double by);
    bool mayPoint(const SessionView& session, Wishes& wishes) const;
    bool mayDraw(const SessionView& session, Wishes& wishes) const;
    void switchDrawing(const SessionView& session, Wishes& wishes);
    void writeNote(const SessionView& session, Wishes& wishes);
    std::string whyNoPlace() const;
    void askForRemoval(const PixelPoint& at, const SessionView& session, Wishes& wishes) const;
    void switchHold(const SessionView& session, Wishes& wishes);

    ViewSettings& settings_;
    OrbitCamera& camera_;
    size_t last_cut_ = 0;  // axis of the cut-plane that was switched or moved last
    bool is_panel_open_ = false;
    bool is_point_key_down_ = false;
    bool is_drawing_ = false;
    StrokePen pen_;
    Drag drag_ = Drag::kNone;
    MouseButton drag_button_ = MouseButton::kLeft;
    PixelPoint mouse_;
    PixelPoint pressed_at_;  // the button of the drag
    ToolHold hold_;
    PaneMouse pane_mouse_;
    std::optional<MouseButtonEvent> last_click_;
    std::optional<Deed> asked_;           // of the user, and not answered
    std::optional<double> last_start_s_;  // of an attempt, by SessionView::time_s
};

}  // namespace bonemill
