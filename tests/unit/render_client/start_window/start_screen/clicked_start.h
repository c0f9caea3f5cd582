// The screen of the window to begin in, clicked without a display.
#pragma once

#include <functional>
#include <stdexcept>

#include "render_client/look/hud/hud_canvas.h"
#include "render_client/start_window/start_screen/start_screen.h"
#include "tests/support/process.h"

namespace bonemill::test {

class ClickedStart {
  public:
    ClickedStart(const std::string& launcher, int width, int height, float desktop_scale = 1)
        : desk(launcher, {}), screen(desk), width_(width), height_(height), desktop_scale_(desktop_scale) {
        await([&] { return desk.hasList() && desk.doctor(); });
    }
    // Several pictures: until ImGui knows how large everything is.
    void look() {
        for (int n = 0; n < 4; ++n) {
            desk.poll();
            screen.setPicture(width_, height_, textScale(width_, height_, 1, desktop_scale_));
            screen.layOut(0.02);
        }
    }
    void await(const std::function<bool()>& condition) {
        const bool has_come = waitFor([&] {
            look();
            return condition();
        });
        if (!has_come) throw std::runtime_error("waited in vain");
    }
    void click(const std::string& label) {
        look();
        const auto place = screen.find(label);
        if (!place) throw std::runtime_error("the screen has no control '" + label + "'");
        screen.handle(MouseMoveEvent{*place});
        look();
        for (const bool is_down : {true, false})
            screen.handle(MouseButtonEvent{MouseButton::kLeft, is_down, *place, {}, 0});
        look();
    }
    void type(const std::string& text) {
        for (const char sign : text) screen.handle(TextEvent{char32_t(sign)});
        look();
    }
    void hit(Key key) {
        for (const bool is_down : {true, false}) {
            screen.handle(KeyEvent{key, is_down});
            look();
        }
    }

    StartDesk desk;
    StartScreen screen;

  private:
    int width_, height_;
    float desktop_scale_;
};

}  // namespace bonemill::test
