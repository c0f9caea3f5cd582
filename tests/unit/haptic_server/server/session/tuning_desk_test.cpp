#include "haptic_server/server/session/tuning_desk.h"

#include <gtest/gtest.h>

#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/unit/haptic_server/server/session/session_commands_rig.h"

namespace bonemill {
namespace {

class TuningDeskTest : public testing::Test {
  protected:
    static scene::Scene sceneOf() {
        scene::Scene scene;
        scene.mutable_coupling()->set_max_force_n(10);
        scene.add_tool()->set_burr_radius_mm(1);
        scene.add_tool()->set_burr_radius_mm(3);
        return scene;
    }
    static scene::Tuning tuningOf(const std::string& text) { return tuningOfText(text).value(); }
    std::string tune(const std::string& text) { return desk_.tune(tuningOf(text)).text; }
    std::string told() const {
        topics::Status status;
        desk_.describe(status);
        return status.has_tuning() ? tuningText(status.tuning()) : "nothing";
    }

    test::MilledBall ball_;
    JournalRecorder journal_{ball_.history, ball_.bone};  // that goes nowhere
    TunableScene scene_{sceneOf(), 0.1e-3};
    TuningSwitch tunings_{scene_.with({})};
    TuningDesk desk_{scene_, tunings_, journal_};
};

TEST_F(TuningDeskTest, WhatTheSceneSaysIsWhatItsTickHas) {
    const TickConfig config = tickConfigOf(sceneOf());
    const TickTuning& own = tunings_[TuningSwitch::kOfScene];
    EXPECT_EQ(own.gradient.translation_stiffness, config.gradient.coupling.translation_stiffness);
    EXPECT_EQ(own.thesis.rotation_stiffness, config.coupling.rotation_stiffness);
    EXPECT_EQ(own.contact.stiffness_per_area, config.gradient.contact.stiffness_per_area);
    EXPECT_EQ(own.hand.max_force, 10);
    ASSERT_EQ(own.saturation_forces.size(), 2u);
    EXPECT_EQ(told(), "nothing");
}

TEST_F(TuningDeskTest, WhatIsTunedIsChosenMadeForTheTickAndTold) {
    EXPECT_EQ(tune("coupling { translation_stiffness_n_per_mm: 1.5 max_force_n: 6 }"), "done");
    EXPECT_EQ(tunings_.chosen(), 1u);
    const TickTuning& tuned = tunings_[1];
    EXPECT_DOUBLE_EQ(tuned.gradient.translation_stiffness, 1500);
    EXPECT_DOUBLE_EQ(tuned.thesis.translation_stiffness, 1500);
    EXPECT_EQ(tuned.hand.max_force, 6);
    EXPECT_LE(tuned.saturation_forces[1], 6);
    EXPECT_EQ(told(), "coupling { translation_stiffness_n_per_mm: 1.5 max_force_n: 6 }");

    // These values, and no others.
    EXPECT_EQ(tune("contact { stiffness_n_per_mm3: 50 }"), "done");
    EXPECT_EQ(tunings_.chosen(), 2u);
    EXPECT_EQ(tunings_[2].hand.max_force, 10);
    EXPECT_DOUBLE_EQ(tunings_[2].contact.stiffness_per_area, 50e9);
    EXPECT_LT(tunings_[2].saturation_forces[0], tunings_[0].saturation_forces[0]) << "soft bone carries less";
    EXPECT_EQ(told(), "contact { stiffness_n_per_mm3: 50 }");
}

TEST_F(TuningDeskTest, TheSameTwiceAndTheScenesOwnTakeNoRoom) {
    EXPECT_EQ(tune("coupling { relaxing_share: 2 }"), "done");
    EXPECT_EQ(tune(""), "done");
    EXPECT_EQ(tunings_.chosen(), TuningSwitch::kOfScene);
    EXPECT_EQ(told(), "nothing");
    EXPECT_EQ(tune("coupling { relaxing_share: 2 max_force_n: 10 }"), "done") << "10 N are the scene's own";
    EXPECT_EQ(tunings_.chosen(), 1u);
    EXPECT_EQ(tunings_.count(), 2u);
    EXPECT_EQ(told(), "coupling { relaxing_share: 2 }");
}

TEST_F(TuningDeskTest, WhatIsRefusedChangesNothing) {
    EXPECT_EQ(tune("coupling { damping_time_ms: 2 }"), "done");
    for (const char* text :
         {"coupling { damping_time_ms: 2 max_force_n: 11 }", "coupling { damping_time_ms: 101 }",
          "coupling { max_speed_mm_per_s: 100 }", "contact { stiffness_n_per_mm3: nan }"}) {
        const std::string answer = tune(text);
        EXPECT_EQ(answer.rfind("refused: field `", 0), 0u) << answer;
        EXPECT_EQ(answer.find('\n'), std::string::npos);
    }
    EXPECT_EQ(tunings_.chosen(), 1u);
    EXPECT_EQ(tunings_.count(), 2u);
    EXPECT_EQ(told(), "coupling { damping_time_ms: 2 }");
}

TEST_F(TuningDeskTest, ThereIsAnEndToThem) {
    scene::Tuning tuning;
    for (uint32_t n = 0; n < TuningSwitch::kMost; ++n) {
        tuning.mutable_coupling()->set_damping_time_ms(2 + 0.01 * n);
        ASSERT_EQ(desk_.tune(tuning).text, "done");
    }
    tuning.mutable_coupling()->set_damping_time_ms(1.5);
    EXPECT_EQ(desk_.tune(tuning).text, "refused: a scene takes 1000 tunings: choose it anew for more");
    tuning.mutable_coupling()->set_damping_time_ms(2);
    EXPECT_EQ(desk_.tune(tuning).text, "done") << "that one is known";
    EXPECT_EQ(tunings_.chosen(), 1u);
}

using TuningByOrder = test::SessionCommandsTest;

TEST_F(TuningByOrder, IsTheInstructorsAlone) {
    const TunableScene scene(sceneOf(), 1e-4);
    TuningSwitch tunings(scene.with({}));
    TuningDesk desk(scene, tunings, journal_);
    SessionControls with_desk = controls();
    with_desk.tuning = &desk;
    SessionCommands commands(sceneOf(), ball_.bone, recorder_, with_desk, false);
    topics::Command command;
    command.mutable_tune()->mutable_coupling()->set_damping_time_ms(3);
    for (const auto role : {topics::Viewer::VIEWER, topics::Viewer::OPERATOR, topics::Viewer::EXAMINER}) {
        command.set_role(role);
        EXPECT_EQ(commands.carryOut(command)->outcome, topics::REFUSED);
    }
    EXPECT_EQ(tunings.count(), 1u);
    command.set_role(topics::Viewer::INSTRUCTOR);
    EXPECT_EQ(commands.carryOut(command)->text, "done");
    EXPECT_EQ(tunings.chosen(), 1u);
    topics::Status status;
    commands.describe(status);
    EXPECT_EQ(status.tuning().coupling().damping_time_ms(), 3);
    EXPECT_EQ(order(command, topics::Viewer::INSTRUCTOR), "refused: nothing can be tuned here");
}

}  // namespace
}  // namespace bonemill
