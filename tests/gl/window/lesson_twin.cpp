#include "tests/gl/window/lesson_twin.h"

#include <chrono>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill::test {

LessonTwin::LessonTwin(uint32_t domain, uint32_t session, int width, int height)
    : subscriber_({.domain = domain, .session = session, .name = "twin"}), width_(width), height_(height) {
    session_.role = topics::Viewer::OPERATOR;
    session_.has_launcher = true;
    session_.past = &past_;
    look();
}

void LessonTwin::look() {
    subscriber_.poll();
    if (subscriber_.sceneInfo()) info_ = *subscriber_.sceneInfo();
    if (subscriber_.status()) status_ = *subscriber_.status();
    session_.has_server = subscriber_.hasServer();
    session_.tool = subscriber_.toolState() ? &*subscriber_.toolState() : nullptr;
    session_.lesson = subscriber_.lesson() ? &*subscriber_.lesson() : nullptr;
    session_.remarks = &subscriber_.remarks();
    session_.time_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    layOut(width_, height_, textScale(width_, height_));
}

std::optional<PixelPoint> LessonTwin::find(const std::string& label) {
    constexpr int kLooksToSettle = 3;  // until a card is as large as what is in it
    for (int n = 0; n < kLooksToSettle; ++n) look();
    return panel_.find(label);
}

void LessonTwin::scroll(const PixelPoint& mouse, int turns) {
    look();
    send(MouseMoveEvent{mouse});
    for (int n = 0; n < turns; ++n) send(ScrollEvent{-1});
    look();
}

}  // namespace bonemill::test
