// A desk with its screen, clicked without a display.
#pragma once

#include <stdexcept>

#include "render_client/case_window/case_screen/case_screen.h"
#include "render_client/look/hud/hud_canvas.h"
#include "tests/support/places.h"
#include "tests/unit/render_client/case_window/case_desk/desk_scan.h"

namespace bonemill::test {

class ClickedScreen {
  public:
    ClickedScreen(CaseRequest request, int width, int height)
        : desk(std::move(request), "test", "make-case"),
          screen(desk, sourceDir() + "/deploy/tools"),
          width_(width),
          height_(height) {
        look();
    }
    // Several pictures: until ImGui knows how large everything is.
    void look() {
        settle(desk);
        for (int n = 0; n < 4; ++n) {
            screen.setPicture(width_, height_, textScale(width_, height_));
            screen.layOut(0.02);
        }
    }
    PixelPoint placeOf(const std::string& label) {
        look();
        for (int n = 0; n < 60 && !screen.find(label); ++n) scrollSteps(-1);
        const auto place = screen.find(label);
        if (!place) throw std::runtime_error("the screen has no control '" + label + "'");
        return *place;
    }
    void scrollSteps(double steps) {
        screen.handle(MouseMoveEvent{{100, double(height_) / 2}});
        screen.handle(ScrollEvent{steps});
        look();
    }
    void moveTo(const PixelPoint& place) { screen.handle(MouseMoveEvent{place}); }
    void press(const PixelPoint& place, bool is_down) {
        screen.handle(MouseButtonEvent{MouseButton::kLeft, is_down, place, {}, 0});
    }
    void clickAt(const PixelPoint& place) {
        moveTo(place);
        look();
        press(place, true);
        press(place, false);
        look();
    }
    void click(const std::string& label) { clickAt(placeOf(label)); }
    void drag(const PixelPoint& from, const PixelPoint& to) {
        moveTo(from);
        press(from, true);
        moveTo({(from.x + to.x) / 2, (from.y + to.y) / 2});
        moveTo(to);
        press(to, false);
        look();
    }
    void type(const std::string& text) {
        for (const char sign : text) screen.handle(TextEvent{char32_t(sign)});
        look();
    }
    void hit(Key key) {
        for (const bool is_down : {true, false}) screen.handle(KeyEvent{key, is_down});
        look();
    }

    CaseDesk desk;
    CaseScreen screen;

  private:
    int width_, height_;
};

}  // namespace bonemill::test
