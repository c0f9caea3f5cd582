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

}  // namespace bonemill
