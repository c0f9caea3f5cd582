// A mouse that clicks the control panel's controls by their labels, without OpenGL.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/controlled_panel.h"

namespace bonemill::test {

inline constexpr int kPanelWidth = 900, kPanelHeight = 1200;

class PanelClicks : public testing::Test, protected ControlledPanel {
  protected:
    PanelClicks() {
        session_.role = topics::Viewer::INSTRUCTOR;
        session_.name = "me";
        info_.add_tool_names("6 mm");
        info_.add_tool_names("3 mm");
        status_.set_preset("balanced");
        for (const uint32_t id : {3u, 5u}) status_.add_checkpoints()->set_id(id);
        switchPanel();
        layOut();
    }

    void layOut() { ControlledPanel::layOut(kPanelWidth, height_); }
    PixelPoint at(const std::string& label) {
        layOut();
        const auto place = panel_.find(label);
        EXPECT_TRUE(place) << "no control '" << label << "' can be seen";
        return place.value_or(PixelPoint{});
    }
    // Press and release come before any picture, as from a quick hand on a slow computer.
    void click(const std::string& label) { click(at(label)); }
    void click(const PixelPoint& place) {
        send(MouseMoveEvent{place});
        EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, true, place, {}, 0}));
        EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, false, place, {}, 0}));
        layOut();
    }
    topics::Command clickForCommand(const std::string& label) {
        wishes_ = {};
        click(label);
        EXPECT_EQ(wishes_.commands.size(), 1u) << label;
        return wishes_.commands.empty() ? topics::Command() : wishes_.commands[0];
    }

    int height_ = kPanelHeight;
};

}  // namespace bonemill::test
