// The mouse holds the tool: cursor, wheel and keys say where the user wants it, and what the burr shall do.
//
// The cursor moves the tool across the plane of the picture that goes through the tool, so that the tool
// stays under it; the wheel moves it along the line of sight, also under the cursor. While the clutch is held
// the tool stays where it is, and the mouse is the camera's. So it does while the camera is dragged, and
// while the cursor is elsewhere: with the next move the tool is under the cursor again. Where the tool was
// turned with the mouse it goes as far as the cursor until the camera moves: turning must not pull it out of
// its hole.
//
// Frames are W and C (camera.h); units are m, rad and pixels. It belongs to the render thread and never
// throws.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/geometry/pose.h"
#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/camera.h"

namespace bonemill {

// A picture that the user looks at, and the camera that took it.
struct PictureView {
    Camera camera;
    int width = 1;  // pixels
    int height = 1;
    // The cursor is somewhere in the scene: not in stereo, nor where the camera rides on the tool. Otherwise
    // the tool goes as far as the cursor.
    bool has_places = true;

    // Returns the point (W) at this depth in front of the eye that is seen at that pixel.
    Eigen::Vector3d pointAt(const PixelPoint& pixel, double depth) const;
    // Returns where a point in front of the eye is seen.
    PixelPoint pixelOf(const Eigen::Vector3d& p_W) const;
    double depthOf(const Eigen::Vector3d& p_W) const;
};

class ToolHold {
  public:
    static constexpr double kDepthPerStep = 0.5;   // burr radii for one notch of the wheel
    static constexpr double kTurnPerHeight = 3.5;  // rad for a drag over the picture's height

    // From now on the user looks at this.
    void lookAt(const PictureView& view);

    // Takes the tool, which shall be there. If it is not under the cursor, it comes there with the first
    // move.
    void begin(const Pose& X_WT, double burr_radius);
    void letGo();
    bool isHolding() const { return is_holding_; }

    // Returns true when the event was meant for the tool and nobody else is to act on it. While the camera
    // is dragged the cursor does not move the tool.
    bool handle(const WindowEvent& event, bool is_camera_dragged);
    // The cursor is there now, and did not mean the tool on its way.
    void passOver(const PixelPoint& to);

    // Returns where the user wants the tool point.
    const Pose& wish() const { return X_WT_; }
    uint32_t buttons() const;  // Button bits
    // Returns where the cursor is; nothing before it has moved.
    const std::optional<PixelPoint>& cursor() const { return mouse_; }

  private:
    bool onKey(const KeyEvent& event);
    bool onButton(const MouseButtonEvent& event);
    void onMove(const PixelPoint& to, bool is_camera_dragged);
    void follow(const PixelPoint& from, const PixelPoint& to);
    void turn(const PixelPoint& from, const PixelPoint& to);
    void moveAlongSight(double steps);
    double depth() const;

    PictureView view_;
    Pose X_WT_;
    double burr_radius_ = 0;
    std::optional<PixelPoint> mouse_;
    bool is_holding_ = false;
    PixelPoint aside_;  // from the cursor to where the tool is seen, since it was turned with the mouse
    struct Held {
        bool mill_button = false, mill_key = false;
        bool add_button = false, add_key = false;
        bool turn_button = false, turn_key = false;
        bool clutch = false;
    } held_;
};

// Returns where a tool begins: on the line of sight of a point of the bone's surface (W), some burr radii in
// front of it. It stays turned as it is (X_WT, if there is one) unless its shaft would then point into the
// picture, through the bone.
Pose beginInFrontOf(const Eigen::Vector3d& surface_W, const Camera& camera, double burr_radius,
                    const std::optional<Pose>& X_WT);

// Watches a tool that a mouse holds: has the bone caught it, and does it mill in the air?
//
// Units are s and m; any clock that goes on will do. It is a plain value, for one thread, and never throws.
class HoldMonitor {
  public:
    static constexpr double kPatience = 2;    // s that the tool is caught, or mills in the air
    static constexpr double kFar = 6e-3;      // m from where it is wanted: more is caught
    static constexpr double kFarBurrs = 4;    // the same in burr radii, if that is more
    static constexpr int kMaxRescues = 2;     // in a row; then only the user can help
    static constexpr double kLongestGap = 1;  // s between two looks; what was in a longer one is not known

    enum class Advice {
        kNone,
        kFree,   // it is caught: to be put in front of the bone
        kHelp,   // that has not helped
        kTouch,  // the burr mills in the air
    };
    struct Sight {
        double now = 0;          // s
        double burr_radius = 0;  // m
        double from_wish = 0;    // m, of the simulated tool
        bool presses = false;    // the user mills, or adds
        bool touches = false;    // the simulated tool has contacts
        bool can_mill = true;    // it is not paused
    };

    // Looks at a tool that is held, once per picture. Each advice comes once.
    Advice look(const Sight& sight) {
        if (sight.now - seen_ > kLongestGap) caught_since_ = pressed_since_ = sight.now;
        seen_ = sight.now;
        const bool is_near = sight.from_wish <= std::max(kFar, kFarBurrs * sight.burr_radius);
        if (is_near) rescues_ = 0;
        if (is_near || sight.presses) caught_since_ = sight.now;
        if (!sight.presses) is_told_ = false;
        if (!sight.presses || sight.touches || !sight.can_mill) pressed_since_ = sight.now;
        if (sight.now - caught_since_ > kPatience && rescues_ <= kMaxRescues) {
            caught_since_ = sight.now;
            return ++rescues_ <= kMaxRescues ? Advice::kFree : Advice::kHelp;
        }
        if (is_told_ || sight.now - pressed_since_ <= kPatience) return Advice::kNone;
        is_told_ = true;
        return Advice::kTouch;
    }

  private:
    double seen_ = -1e9, caught_since_ = 0, pressed_since_ = 0;
    int rescues_ = 0;
    bool is_told_ = false;
};

}  // namespace bonemill
