// Compares a replay with another attempt by clicks in the control panel, without OpenGL.
#include <gtest/gtest.h>

#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class PanelReplay : public testing::Test, protected test::ControlledPanel {
  protected:
    PanelReplay() {
        switchPanel();
        status_.mutable_replay()->set_length_s(100);
        session_.same_scene = &attempts_;
        session_.recording = "/r/a.mcap";
        show();
    }
    void show() {
        for (int n = 0; n < 3; ++n) layOut(900, 2400);
    }
    void click(const std::string& label) {
        clickAt(label);
        show();
    }
    const topics::ReplayOrder& ordered() const {
        EXPECT_EQ(wishes_.commands.size(), 1u);
        return wishes_.commands.back().replay();
    }
    static PastAttempt attempt(const std::string& stem, const std::string& recording) {
        return {stem, recording, "2026-11-20 11:36", "Pedicle", "P07", "score 81 of 100", ""};
    }

    std::vector<PastAttempt> attempts_{attempt("/class/results/b_P07_1", "/r/b.mcap"),
                                       attempt("/class/results/a_P07_1", "/r/a.mcap"),
                                       attempt("/class/experts/e_E1_1", "/r/e.mcap")};
};

TEST_F(PanelReplay, OffersTheOtherAttempts) {
    const std::string who = "P07, 2026-11-20 11:36, score 81 of 100##compare ";
    click(who + "1");
    EXPECT_EQ(ordered().compare_with(), "b_P07_1");
    click("expert " + who + "2");
    EXPECT_EQ(ordered().compare_with(), "e_E1_1");
    EXPECT_FALSE(panel_.find(who + "3")) << "itself";
    EXPECT_FALSE(panel_.find("Alone")) << "it is alone";
    session_.role = topics::Viewer::VIEWER;
    show();
    click(who + "1");
    EXPECT_TRUE(wishes_.commands.empty()) << "who only looks leads nothing";
}

TEST_F(PanelReplay, SwitchesTheDifference) {
    topics::Comparison& comparison = *status_.mutable_replay()->mutable_comparison();
    comparison.set_attempt("P07, 2026-11-20 11:36");
    show();
    EXPECT_FALSE(panel_.find("Difference")) << "no numbers are left for its colours";
    comparison.set_first_material(1);
    show();
    click("Difference");
    EXPECT_TRUE(ordered().shows_difference());
    comparison.set_shows_difference(true);
    show();
    click("Difference");
    EXPECT_TRUE(ordered().has_shows_difference());
    EXPECT_FALSE(ordered().shows_difference());
    click("Both bones");
    EXPECT_TRUE(ordered().shows_beside());
    click("Alone");
    EXPECT_TRUE(ordered().has_compare_with());
    EXPECT_EQ(ordered().compare_with(), "");
}

TEST_F(PanelReplay, WhatCannotBeComparedShowsNoDifference) {
    topics::Comparison& comparison = *status_.mutable_replay()->mutable_comparison();
    comparison.set_problem("b.mcap: is of another scene");
    comparison.set_first_material(1);
    show();
    EXPECT_FALSE(panel_.find("Difference"));
    EXPECT_FALSE(panel_.find("Both bones"));
    EXPECT_TRUE(panel_.find("Alone"));
}

// Whatever a server says of materials.
TEST_F(PanelReplay, ALegendNeedsItsColours) {
    topics::Comparison& comparison = *status_.mutable_replay()->mutable_comparison();
    comparison.set_shows_difference(true);
    for (const uint32_t first : {1u, 127u, 4294967295u}) {
        comparison.set_first_material(first);
        show();
        EXPECT_TRUE(panel_.find("Difference")) << first;
    }
}

}  // namespace
}  // namespace bonemill
