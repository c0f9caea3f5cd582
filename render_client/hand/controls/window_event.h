// This happens at a window: keys, text, mouse. They are plain values that name no window library,
// for any thread.
//
// Positions are pixels of the picture from its upper left corner, times are s of a steady clock.
#pragma once

#include <variant>

namespace bonemill {

// A key goes by what is printed on it: letters and digits are their upper-case ASCII signs.
enum class Key : int {
    kNone = 0,
    kSpace = 32,
    kEnter = 256,
    kTab,
    kBackspace,
    kDelete,
    kEscape,
    kLeft,
    kRight,
    kUp,
    kDown,
    kHome,
    kEnd,
    kF11,
    kF12,
};

constexpr Key keyOf(char sign) {
    return Key(sign);
}

struct Modifiers {
    bool shift = false;
    bool control = false;
};

// Where a window is, without its frame, in screen coordinates.
struct WindowPlace {
    int x = 0, y = 0;
    int width = 0, height = 0;
    bool operator==(const WindowPlace&) const = default;
};

struct PixelPoint {
    double x = 0;
    double y = 0;
};

struct KeyEvent {
    Key key = Key::kNone;
    bool is_down = true;
    bool is_repeat = false;
    Modifiers held = {};
};

// A sign comes as the keyboard's layout makes it, again while its key is held.
struct TextEvent {
    char32_t sign = 0;
};

enum class MouseButton { kLeft, kRight, kMiddle };

struct MouseButtonEvent {
    MouseButton button = MouseButton::kLeft;
    bool is_down = true;
    PixelPoint at = {};
    Modifiers held = {};
    double time = 0;
};

struct MouseMoveEvent {
    PixelPoint to = {};
};

// Counts notches of the wheel, positive away from the user.
struct ScrollEvent {
    double steps = 0;
};

using WindowEvent = std::variant<KeyEvent, TextEvent, MouseButtonEvent, MouseMoveEvent, ScrollEvent>;

}  // namespace bonemill
