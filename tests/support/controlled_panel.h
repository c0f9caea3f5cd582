// It is a viewer's controls with the panel, as the tests that click and draw it need them.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "render_client/panel/panel/panel.h"
#include "tests/support/controlled_viewer.h"

namespace bonemill::test {

class ControlledPanel : protected ControlledViewer {
  protected:
    void switchPanel() { controls_.act(Action::kPanel, session_, wishes_); }
    // The panel is laid out in a picture of this size (pixels).
    void layOut(int width, int height, float scale = 1) {
        panel_.setPicture(width, height, width, scale, 0.02);
        panel_.layOut(controls_, session_, wishes_);
    }
    bool send(const WindowEvent& event) { return panel_.handle(event, controls_, session_, wishes_); }
    // Presses and releases the mouse on the control of this label, where it was laid out last; before any
    // picture, as from a quick hand on a slow computer. What was wished before is forgotten.
    void clickAt(const std::string& label) {
        const auto place = panel_.find(label);
        ASSERT_TRUE(place) << "no control '" << label << "' can be seen";
        wishes_ = {};
        send(MouseMoveEvent{*place});
        EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, true, *place, {}, 0}));
        EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, false, *place, {}, 0}));
    }

    Panel panel_;
};

}  // namespace bonemill::test
