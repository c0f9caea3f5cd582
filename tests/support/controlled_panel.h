// It is a viewer's controls with the panel, as the tests that click and draw it need them.
#pragma once

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

    Panel panel_;
};

}  // namespace bonemill::test
