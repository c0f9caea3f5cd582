#include "render_client/window/glfw_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/user_error.h"

namespace bonemill {
namespace {

constexpr double kOrbitPerHeight = 3.5;  // rad for a drag over the window's height
constexpr double kZoomPerStep = 0.9;     // distance factor of one notch of the wheel
constexpr int kAccuracyKeys = 5;         // 0 .. 4, in the digit row or on the number pad

std::optional<int> digitOf(int key) {
    for (int digit = 0; digit < kAccuracyKeys; ++digit)
        if (key == GLFW_KEY_0 + digit || key == GLFW_KEY_KP_0 + digit) return digit;
    return std::nullopt;
}

[[noreturn]] void failWith(const std::string& what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw UserError(what + (reason ? std::string(": ") + reason : "") +
                    ". Without a display use: render_client --offscreen --frames N --out DIR");
}

}  // namespace

GlfwWindow::Library::Library() {
    if (!glfwInit()) failWith("cannot open a window");
}

GlfwWindow::Library::~Library() {
    glfwTerminate();
}

GlfwWindow::GlfwWindow(int width, int height, const std::string& title) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) failWith("cannot open a window with OpenGL 3.3");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    gl_ = GlApi::load([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); });
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* w, int key, int, int action, int) { of(w).onKey(key, action); });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).onMove(x, y); });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { of(w).onScroll(y); });
    glfwGetCursorPos(window_, &mouse_x_, &mouse_y_);
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(window_);
}

GlfwWindow& GlfwWindow::of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

WindowInput GlfwWindow::takeInput() {
    glfwPollEvents();
    return std::exchange(input_, WindowInput());
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

void GlfwWindow::show() {
    glfwSwapBuffers(window_);
}

void GlfwWindow::onKey(int key, int action) {
    if (action != GLFW_PRESS) return;
    if (const auto digit = digitOf(key)) input_.accuracy_key = digit;
    switch (key) {
        case GLFW_KEY_R:
            input_.reset_view = true;
            break;
        case GLFW_KEY_C:
            input_.reset_volume = true;
            break;
        case GLFW_KEY_H:
            input_.toggle_help = !input_.toggle_help;
            break;
        case GLFW_KEY_ESCAPE:
            glfwSetWindowShouldClose(window_, GLFW_TRUE);
            break;
        default:
            break;
    }
}

void GlfwWindow::onMove(double x, double y) {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    const double right = (x - std::exchange(mouse_x_, x)) / std::max(height, 1);
    const double down = (y - std::exchange(mouse_y_, y)) / std::max(height, 1);
    const auto holds = [this](int button) { return glfwGetMouseButton(window_, button) == GLFW_PRESS; };
    const bool shift = glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                       glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    const bool left = holds(GLFW_MOUSE_BUTTON_LEFT);
    if (holds(GLFW_MOUSE_BUTTON_RIGHT) || holds(GLFW_MOUSE_BUTTON_MIDDLE) || (left && shift)) {
        input_.pan_right += right;
        input_.pan_up -= down;
    } else if (left) {
        input_.orbit_azimuth -= right * kOrbitPerHeight;
        input_.orbit_elevation += down * kOrbitPerHeight;
    }
}

void GlfwWindow::onScroll(double steps) {
    input_.zoom_factor *= std::pow(kZoomPerStep, steps);
}

}  // namespace bonemill
