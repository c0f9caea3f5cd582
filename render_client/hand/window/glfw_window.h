// It is a window with an OpenGL 3.3 core context, and tells what happens at it.
//
// It belongs to the main thread. There is one window per process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render_client/hand/controls/window_event.h"
#include "render_client/look/gl/gl_api.h"

struct GLFWcursor;
struct GLFWwindow;

namespace bonemill {

class GlfwWindow {
  public:
    // The size counts in screen coordinates, and is at most what the first monitor has room for. The window
    // opens where one was `before`, if a monitor is there. Throws UserError, ending with `advice`, when there
    // is no display or no OpenGL 3.3.
    GlfwWindow(int width, int height, const std::string& title, const std::string& advice,
               const std::optional<WindowPlace>& before = std::nullopt);
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;
    ~GlfwWindow();

    const GlApi& gl() const { return gl_; }

    // Returns what happened since the last call, oldest first. Never waits.
    std::vector<WindowEvent> takeEvents();
    bool shouldClose() const;

    // Returns the paths of files and folders that were dropped onto the window since the last call.
    std::vector<std::string> takeDropped();
    // The display's clipboard; empty: it holds no text.
    std::string clipboard() const;
    void setClipboard(const std::string& text);

    // The picture has so many pixels, 0 x 0 while the window is minimised.
    int pixelWidth() const;
    int pixelHeight() const;
    // Returns how much larger than usual the display wants its text.
    float contentScale() const;

    // Returns where the window is; of a full screen where it was before.
    WindowPlace place() const;
    bool isFullScreen() const;
    // Fills the monitor that the window is on, or goes back to where it was.
    void switchFullScreen();

    // The cursor is a crosshair, or the usual arrow.
    void showCrosshair(bool is_wanted);

    // Where the desktop wants larger text the window becomes as much larger, as far as the first monitor has
    // room.
    void growWithText();

    // Takes the window off the desktop, or puts it there again.
    void setVisible(bool is_visible);

    // Shows the picture; waits for the display's next refresh.
    void show();

  private:
    struct Library {  // glfwInit and glfwTerminate
        explicit Library(const std::string& advice);
        ~Library();
    };
    static GlfwWindow& of(GLFWwindow* window);
    void listen();
    PixelPoint toPixels(double x, double y) const;
    void onButton(int button, int action, int modifiers);

    Library library_;
    GLFWwindow* window_;
    GLFWcursor* crosshair_ = nullptr;  // null: the display has none
    bool shows_crosshair_ = false;
    WindowPlace windowed_;  // of a full screen: where the window was
    GlApi gl_;
    std::vector<WindowEvent> events_;
    std::vector<std::string> dropped_;
    PixelPoint mouse_;  // of the last event: the mouse itself may be elsewhere by the time it is handled
};

}  // namespace bonemill
