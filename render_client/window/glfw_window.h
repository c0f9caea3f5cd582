// A window with an OpenGL 3.3 core context, and what mouse and keys ask of the viewer.
//
// Thread: the main thread, one window per process.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render_client/gl/gl_api.h"

struct GLFWwindow;

namespace bonemill {

// What the user did since the last look. Angles in rad, pans in picture heights (OrbitCamera).
struct WindowInput {
    double orbit_azimuth = 0;
    double orbit_elevation = 0;
    double pan_right = 0;
    double pan_up = 0;
    double zoom_factor = 1;
    bool reset_view = false;
    bool reset_volume = false;
    bool toggle_help = false;
    std::optional<int> accuracy_key;  // 0 .. 4: the digit that was pressed last
};

class GlfwWindow {
  public:
    // Size in screen coordinates. Throws UserError, naming --offscreen, when there is no display or no
    // OpenGL 3.3.
    GlfwWindow(int width, int height, const std::string& title);
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;
    ~GlfwWindow();

    const GlApi& gl() const { return gl_; }

    // Handles what happened and returns it. Never waits.
    WindowInput takeInput();
    bool shouldClose() const;

    // Pixels; 0 x 0 while the window is minimised.
    int pixelWidth() const;
    int pixelHeight() const;
    // How much larger than usual the display wants its text.
    float contentScale() const;

    // Shows the picture; waits for the display's next refresh.
    void show();

  private:
    struct Library {  // glfwInit and glfwTerminate
        Library();
        ~Library();
    };
    static GlfwWindow& of(GLFWwindow* window);
    void onKey(int key, int action);
    void onMove(double x, double y);
    void onScroll(double steps);

    Library library_;
    GLFWwindow* window_;
    GlApi gl_;
    WindowInput input_;
    double mouse_x_ = 0;
    double mouse_y_ = 0;
};

}  // namespace bonemill
