// The panel in every language: chosen by a click, and without words that are cut.
#include <imgui.h>

#include "common/device_messages/device_messages.h"
#include "render_client/panel/panel/panel.h"
#include "tests/support/cut_words.h"
#include "tests/support/spoken.h"
#include "tests/unit/render_client/panel/panel/panel_clicks.h"

namespace bonemill {
namespace {

// All that the panel can show outside of a replay.
class WholePanel : public test::PanelClicks {
  protected:
    WholePanel() {
        height_ = 4000;  // all of it is seen at once
        status_.mutable_device()->set_kind(uint32_t(DeviceKind::kPointer));
        status_.mutable_training()->set_damaged_mm3(0.2);
        status_.mutable_training()->set_max_protected_force_n(1);
        for (topics::Checkpoint& checkpoint : *status_.mutable_checkpoints())
            checkpoint.set_removed_mm3(123.4);
        info_.add_materials()->set_name("facial nerve");
        info_.mutable_materials(0)->set_is_protected(true);
        info_.set_handpiece(topics::SceneInfo::STRAIGHT);
        scene::Effects& effects = *info_.mutable_viewer_effects();
        effects.mutable_bone_dust(), effects.mutable_bleeding(), effects.mutable_irrigation();
        effects.mutable_burr_spin(), effects.mutable_milling_sound(), effects.mutable_browning();
        effects.mutable_bruising(), effects.mutable_pulse();
        session_.tool = &tool_;
        session_.others.emplace_back().set_name("Ann");
        session_.picture_s = 0.0123;
        settings_.picks_quality = true;
        settings_.camera = CameraMode::kMicroscope;
        remarks_[1].set_number(1);
        remarks_[1].set_note("here");
        session_.remarks = &remarks_;
        topics::SceneChoice& scene = *lesson_.add_scenes();
        scene.set_id("tooth"), scene.set_title("Tooth");
        lesson_.set_is_running(true);
        topics::Attempt& attempt = *lesson_.add_attempts();
        attempt.set_number(1), attempt.set_trainee("Ann"), attempt.set_scene_id("tooth");
        session_.lesson = &lesson_;
        session_.class_folder = "/class";
    }
    void expectNoCutWords(int least) {
        for (const Language& language : languages()) {
            const test::Spoken spoken(language.code);
            for (int n = 0; n < 4; ++n) layOut();
            int letters = 0;
            EXPECT_EQ(test::placesOfCuts(*panel_.drawData(), letters), "") << language.name;
            EXPECT_GT(letters, least) << language.name;
        }
    }

    topics::ToolState tool_;
    topics::Lesson lesson_;
    std::map<uint32_t, topics::Remark> remarks_;
};

TEST_F(WholePanel, NoLanguageHasWordsThatAreCut) {
    expectNoCutWords(1000);
}

TEST_F(WholePanel, NorInAReplay) {
    topics::Replay& replay = *status_.mutable_replay();
    replay.set_length_s(100), replay.set_speed(0.125), replay.set_is_playing(true);
    topics::Comparison& comparison = *replay.mutable_comparison();
    comparison.set_attempt("Ann");
    comparison.set_first_material(1);
    session_.recording = "/r.mcap";
    expectNoCutWords(1000);
}

TEST_F(WholePanel, ALanguageIsChosenByItsOwnName) {
    click("Deutsch");
    EXPECT_EQ(wishes_.language, "de");
    wishes_ = {};
    const test::Spoken spoken("de");
    click("Deutsch");
    EXPECT_EQ(wishes_.language, "") << "it is spoken already";
    click("English");
    EXPECT_EQ(wishes_.language, "en");
    click("Schnitt Y");
    EXPECT_TRUE(settings_.cuts[1].is_on);
}

TEST_F(WholePanel, FoldsStayAcrossLanguages) {
    layOut();
    panel_.fold({{"Session", false}});
    const test::Spoken spoken("sv");
    layOut();
    EXPECT_FALSE(panel_.find("Avsluta sessionen"));
    EXPECT_EQ(panel_.folds().count("Session"), 1u);
    panel_.fold({{"Session", true}});
    EXPECT_TRUE((layOut(), panel_.find("Avsluta sessionen")));
}

}  // namespace
}  // namespace bonemill
