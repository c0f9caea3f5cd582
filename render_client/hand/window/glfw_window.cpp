#include "render_client/hand/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr struct {
    int glfw;
    Key key;
} kSpecialKeys[] = {
    {GLFW_KEY_ENTER, Key::kEnter},   {GLFW_KEY_KP_ENTER, Key::kEnter},
    {GLFW_KEY_TAB, Key::kTab},       {GLFW_KEY_BACKSPACE, Key::kBackspace},
    {GLFW_KEY_DELETE, Key::kDelete}, {GLFW_KEY_ESCAPE, Key::kEscape},
    {GLFW_KEY_LEFT, Key::kLeft},     {GLFW_KEY_RIGHT, Key::kRight},
    {GLFW_KEY_UP, Key::kUp},         {GLFW_KEY_DOWN, Key::kDown},
    {GLFW_KEY_HOME, Key::kHome},     {GLFW_KEY_END, Key::kEnd},
    {GLFW_KEY_F11, Key::kF11},       {GLFW_KEY_F12, Key::kF12},
    {GLFW_KEY_SPACE, Key::kSpace},
};

// GLFW names letters by their place on a US keyboard; the user reads what is printed on them.
Key letterOf(int key, int scancode) {
    const char* name = glfwGetKeyName(key, scancode);
    if (name && name[1] == '\0' && std::isalpha(static_cast<unsigned char>(name[0])))
        return keyOf(char(std::toupper(static_cast<unsigned char>(name[0]))));
    const bool is_latin = name && static_cast<unsigned char>(name[0]) < 0x80;
    return !is_latin && key >= GLFW_KEY_A && key <= GLFW_KEY_Z ? Key(key) : Key::kNone;
}

Key keyOfGlfw(int key, int scancode) {
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) return Key(key);
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return Key(key - GLFW_KEY_KP_0 + '0');
    for (const auto& special : kSpecialKeys)
        if (special.glfw == key) return special.key;
    return letterOf(key, scancode);
}

Modifiers modifiersOf(int bits) {
    return {(bits & GLFW_MOD_SHIFT) != 0, (bits & GLFW_MOD_CONTROL) != 0};
}

[[noreturn]] void failWith(const std::string& what, const std::string& advice) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw UserError(what + (reason ? std::string(": ") + reason : "") + ". " + advice);
}

// Returns width and height that the first monitor has for windows; without one, more than any window takes.
std::array<int, 2> monitorRoom() {
    constexpr int kAny = 1 << 20;
    int x = 0, y = 0, width = 0, height = 0;
    if (GLFWmonitor* const monitor = glfwGetPrimaryMonitor())
        glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    return width > 0 && height > 0 ? std::array{width, height} : std::array{kAny, kAny};
}

// Returns how many square screen coordinates of the place this monitor shows.
int64_t overlap(GLFWmonitor* monitor, const WindowPlace& place) {
    const GLFWvidmode* const mode = glfwGetVideoMode(monitor);
    if (!mode) return 0;
    int x = 0, y = 0;
    glfwGetMonitorPos(monitor, &x, &y);
    const int64_t wide = std::min(place.x + place.width, x + mode->width) - std::max(place.x, x);
    const int64_t high = std::min(place.y + place.height, y + mode->height) - std::max(place.y, y);
    return wide > 0 && high > 0 ? wide * high : 0;
}

// Returns the monitor that shows most of the place; null where none shows any of it.
GLFWmonitor* monitorOf(const WindowPlace& place) {
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    GLFWmonitor* best = nullptr;
    int64_t most = 0;
    for (int i = 0; i < count; ++i)
        if (const int64_t shown = overlap(monitors[i], place); shown > most) {
            most = shown;
            best = monitors[i];
        }
    return best;
}

}  // namespace

GlfwWindow::Library::Library(const std::string& advice) {
    if (!glfwInit()) failWith("cannot open a window", advice);
}

GlfwWindow::Library::~Library() {
    glfwTerminate();
}

GlfwWindow::GlfwWindow(int width, int height, const std::string& title, const std::string& advice,
                       const std::optional<WindowPlace>& before)
    : library_(advice) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // a full screen stays while another one is worked at
    const std::array<int, 2> room = monitorRoom();
    width = std::min(width, room[0]);
    height = std::min(height, room[1]);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) failWith("cannot open a window with OpenGL 3.3", advice);
    std::array<int, 4> frame{};  // left, top, right, bottom
    glfwGetWindowFrameSize(window_, &frame[0], &frame[1], &frame[2], &frame[3]);
    const int wide = std::min(width, room[0] - frame[0] - frame[2]),
              high = std::min(height, room[1] - frame[1] - frame[3]);
    if (wide < width || high < height) glfwSetWindowSize(window_, wide, high);
    if (before && monitorOf(*before)) glfwSetWindowPos(window_, before->x, before->y);
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    gl_ = GlApi::load([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); });
    glfwSetWindowUserPointer(window_, this);
    crosshair_ = glfwCreateStandardCursor(GLFW_CROSSHAIR_CURSOR);
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    mouse_ = toPixels(x, y);
    listen();
}

void GlfwWindow::listen() {
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
        of(w).events_.push_back(KeyEvent{keyOfGlfw(key, scancode), action != GLFW_RELEASE,
                                         action == GLFW_REPEAT, modifiersOf(modifiers)});
    });
    glfwSetCharCallback(window_,
                        [](GLFWwindow* w, unsigned sign) { of(w).events_.push_back(TextEvent{sign}); });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
        of(w).onButton(button, action, modifiers);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        of(w).mouse_ = of(w).toPixels(x, y);
        of(w).events_.push_back(MouseMoveEvent{of(w).mouse_});
    });
    glfwSetScrollCallback(window_,
                          [](GLFWwindow* w, double, double y) { of(w).events_.push_back(ScrollEvent{y}); });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        of(w).dropped_.insert(of(w).dropped_.end(), paths, paths + count);
    });
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(window_);
}

GlfwWindow& GlfwWindow::of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

std::vector<WindowEvent> GlfwWindow::takeEvents() {
    glfwPollEvents();
    return std::exchange(events_, {});
}

std::vector<std::string> GlfwWindow::takeDropped() {
    return std::exchange(dropped_, {});
}

std::string GlfwWindow::clipboard() const {
    const char* const text = glfwGetClipboardString(window_);
    return text ? text : "";
}

void GlfwWindow::setClipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

bool GlfwWindow::shouldClose() const {
    return glfwWindowShouldClose(window_);
}

int GlfwWindow::pixelWidth() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return width;
}

int GlfwWindow::pixelHeight() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return height;
}

float GlfwWindow::contentScale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return y;
}

WindowPlace GlfwWindow::place() const {
    if (isFullScreen()) return windowed_;
    WindowPlace place;
    glfwGetWindowPos(window_, &place.x, &place.y);
    glfwGetWindowSize(window_, &place.width, &place.height);
    return place;
}

bool GlfwWindow::isFullScreen() const {
    return glfwGetWindowMonitor(window_) != nullptr;
}

void GlfwWindow::switchFullScreen() {
    if (isFullScreen())
        return glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width,
                                    windowed_.height, GLFW_DONT_CARE);
    windowed_ = place();
    GLFWmonitor* const monitor = monitorOf(windowed_) ? monitorOf(windowed_) : glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (mode) glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    glfwSwapInterval(1);  // some drivers forget it
}

void GlfwWindow::showCrosshair(bool is_wanted) {
    if (std::exchange(shows_crosshair_, is_wanted) != is_wanted)
        glfwSetCursor(window_, is_wanted ? crosshair_ : nullptr);
}

void GlfwWindow::growWithText() {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    if (pixelWidth() > width) return;  // it counts in larger units than pixels, and has grown by that
    const std::array<int, 2> room = monitorRoom();
    glfwSetWindowSize(window_, std::min(int(float(width) * contentScale()), room[0]),
                      std::min(int(float(height) * contentScale()), room[1]));
}

void GlfwWindow::setVisible(bool is_visible) {
    is_visible ? glfwShowWindow(window_) : glfwHideWindow(window_);
}

void GlfwWindow::show() {
    glfwSwapBuffers(window_);
}

PixelPoint GlfwWindow::toPixels(double x, double y) const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return {x * pixelWidth() / std::max(width, 1), y * pixelHeight() / std::max(height, 1)};
}

void GlfwWindow::onButton(int button, int action, int modifiers) {
    MouseButtonEvent event{MouseButton::kLeft, action == GLFW_PRESS, mouse_, modifiersOf(modifiers),
                           glfwGetTime()};
    if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        event.button = MouseButton::kRight;
    } else if (button == GLFW_MOUSE_BUTTON_MIDDLE) {
        event.button = MouseButton::kMiddle;
    } else if (button != GLFW_MOUSE_BUTTON_LEFT) {
        return;
    }
    events_.push_back(event);
}

}  // namespace bonemill
