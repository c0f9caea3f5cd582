// What comes after a scripted hand, and the tuning of the contact law, by the mouse.
#include <gtest/gtest.h>

#include "common/device_messages/device_messages.h"
#include "tests/unit/render_client/panel/panel/panel_clicks.h"

namespace bonemill {
namespace {

using test::PanelClicks;

TEST_F(PanelClicks, AfterAScriptTwoButtonsStandOverThePictureAlsoWithoutThePanel) {
    for (const bool is_open : {true, false}) {
        status_.clear_device();
        layOut();
        EXPECT_FALSE(panel_.find("Again (Shift+C)"));
        status_.mutable_device()->mutable_script()->set_has_ended(true);
        for (int n = 0; n < 3; ++n) layOut();  // until it is as large as its content
        EXPECT_TRUE(clickForCommand("Again (Shift+C)").begin_again());
        EXPECT_TRUE(clickForCommand("Take over (G)").take_over());
        if (is_open) switchPanel();
    }
    session_.role = topics::Viewer::VIEWER;
    layOut();
    EXPECT_FALSE(panel_.find("Take over (G)")) << "who only looks says nothing";
    EXPECT_FALSE(panel_.drawData());
}

TEST_F(PanelClicks, WhoHasTakenOverGivesTheHandBackToTheScript) {
    status_.mutable_device()->set_kind(uint32_t(DeviceKind::kPointer));
    layOut();
    EXPECT_FALSE(panel_.find("Again")) << "there is no script";
    status_.mutable_device()->mutable_script()->set_taken_over_by(9);
    EXPECT_FALSE(panel_.find("Take over (G)"));
    EXPECT_TRUE(clickForCommand("Again (Shift+C)").begin_again());
}

TEST_F(PanelClicks, AnInstructorTunesTheContactLawAndCopiesItAsSceneText) {
    info_.mutable_tunable()->mutable_coupling()->set_damping_time_ms(2);
    info_.mutable_tunable()->mutable_coupling()->set_max_force_n(8);
    status_.mutable_tuning()->mutable_coupling()->set_relaxing_share(3);
    height_ = 2400;
    layOut();
    EXPECT_FALSE(panel_.find("coupling.damping_time_ms")) << "it is folded at first";
    click("Tuning");
    // The slider's left end is its least, and what was tuned before stays.
    const topics::Command softer = clickForCommand("coupling.damping_time_ms");
    EXPECT_LT(softer.tune().coupling().damping_time_ms(), 2);
    EXPECT_GE(softer.tune().coupling().damping_time_ms(), 0.25);
    EXPECT_EQ(softer.tune().coupling().relaxing_share(), 3);
    EXPECT_FALSE(softer.tune().coupling().has_max_force_n());
    EXPECT_EQ(clickForCommand("As the scene file").tune().ByteSizeLong(), 0u);
    click("Copy");
    EXPECT_EQ(wishes_.copy, "coupling { relaxing_share: 3 }\naccuracy { preset: BALANCED }");
    for (const auto role : {topics::Viewer::OPERATOR, topics::Viewer::VIEWER}) {
        session_.role = role;
        layOut();
        EXPECT_FALSE(panel_.find("Tuning"));
    }
}

}  // namespace
}  // namespace bonemill
