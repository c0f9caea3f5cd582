#include "render_client/viewer_options/preferences.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

const Preferences kOthers{.place = WindowPlace{-30, 40, 900, 700},
                          .quality = Quality::kQuick,
                          .camera = CameraMode::kMicroscope,
                          .text_scale = 1.25,
                          .is_for_colour_blind = true,
                          .is_panel_open = true,
                          .folds = {{"Tuning", true}, {"View", false}}};

ClientOptions optionsOf(std::vector<const char*> words) {
    words.insert(words.begin(), "render_client");
    return *parseOptions(int(words.size()), words.data());
}

TEST(Preferences, WhatIsWrittenIsRead) {
    EXPECT_EQ(preferencesOf(textOf(kOthers)), kOthers);
    EXPECT_EQ(preferencesOf(textOf(Preferences())), Preferences());
    EXPECT_EQ(preferencesOf("{}"), Preferences()) << "as at the first start";
    EXPECT_EQ(preferencesOf(R"({"of_a_later_version": [1]})"), Preferences());
}

TEST(Preferences, NothingIsTrusted) {
    for (const char* text :
         {"", "nonsense", "[]", "3", R"({"quality": 1})", R"({"quality": "best"})", R"({"camera": "fly"})",
          R"({"text_scale": 0})", R"({"text_scale": 1e9})", R"({"text_scale": "1"})",
          R"({"panel_is_open": 1})", R"({"panel_parts_open": []})", R"({"panel_parts_open": {"View": 2}})",
          R"({"window": 1})", R"({"window": {"x": 0, "y": 0}})",
          R"({"window": {"x": 0, "y": 0, "width": 1e30, "height": 800}})",
          R"({"window": {"x": 0, "y": 0, "width": 10, "height": 800}})"})
        EXPECT_THROW(preferencesOf(text), UserError) << text;
}

TEST(Preferences, OfASceneNothingIsRemembered) {
    ClientOptions options;
    startAs(kOthers, options);
    for (const CutPlane& cut : options.settings.cuts) EXPECT_FALSE(cut.is_on);
}

TEST(Preferences, TheWindowStartsAsItWas) {
    ClientOptions options = optionsOf({});
    EXPECT_TRUE(options.chooses_quality);
    startAs(kOthers, options);
    EXPECT_EQ(options.width, 900);
    EXPECT_EQ(options.height, 700);
    EXPECT_EQ(options.settings.quality, Quality::kQuick);
    EXPECT_FALSE(options.chooses_quality);
    EXPECT_EQ(options.settings.camera, CameraMode::kMicroscope);
    EXPECT_EQ(options.settings.text_scale, 1.25);
}

TEST(Preferences, TheCommandLineWins) {
    ClientOptions options =
        optionsOf({"--size", "640x480", "--quality", "full", "--camera", "orbit", "--text-scale", "2"});
    startAs(kOthers, options);
    EXPECT_EQ(options.width, 640);
    EXPECT_EQ(options.height, 480);
    EXPECT_EQ(options.settings.quality, Quality::kFull);
    EXPECT_EQ(options.settings.camera, CameraMode::kOrbit);
    EXPECT_EQ(options.settings.text_scale, 2);
    ClientOptions by_speed = optionsOf({"--quality", "auto"});
    startAs(kOthers, by_speed);
    EXPECT_TRUE(by_speed.chooses_quality);
}

TEST(Preferences, OnlyWhatTheUserChangesIsKept) {
    Preferences start = kOthers;
    start.quality = Quality::kFull;  // by the command line
    Preferences now = start;
    EXPECT_EQ(toKeep(kOthers, start, now), kOthers);
    now.text_scale = 2;
    EXPECT_EQ(toKeep(kOthers, start, now).text_scale, 2);
    EXPECT_EQ(toKeep(kOthers, start, now).quality, Quality::kQuick);
    now.quality.reset();
    EXPECT_FALSE(toKeep(kOthers, start, now).quality) << "by speed from now on";
}

class Kept : public testing::Test {
  protected:
    std::string text() const {
        std::ifstream stream(file_);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    test::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_.path() / "bonemill" / "viewer.json";
    PreferenceKeeper::Clock::time_point now_{1000s};
};

TEST_F(Kept, ItIsWrittenOnceItRests) {
    PreferenceKeeper keeper(file_);
    keeper.keep(kOthers, now_);
    keeper.keep(kOthers, now_ + 1s);
    EXPECT_FALSE(std::filesystem::exists(file_)) << "a window that is still being dragged";
    keeper.keep(kOthers, now_ + PreferenceKeeper::kQuiet);
    EXPECT_EQ(PreferenceKeeper(file_).kept(), kOthers);
}

TEST_F(Kept, TheEndWritesAtOnceAndOnlyWhatIsNew) {
    PreferenceKeeper keeper(file_);
    keeper.finish();
    EXPECT_FALSE(std::filesystem::exists(file_)) << "nothing was changed";
    keeper.keep(kOthers, now_);
    keeper.finish();
    EXPECT_EQ(PreferenceKeeper(file_).kept(), kOthers);
}

TEST_F(Kept, AFileThatMakesNoSenseIsAsNone) {
    std::filesystem::create_directories(file_.parent_path());
    for (const std::string& text : {std::string("{\"camera\": \"fl"), std::string(70'000, ' ') + "{}",
                                    std::string("{\"camera\": \"orbit\", \"text_scale\": 99}")}) {
        std::ofstream(file_, std::ios::trunc) << text;
        EXPECT_EQ(PreferenceKeeper(file_).kept(), Preferences()) << text.substr(0, 80);
    }
}

TEST_F(Kept, WhereNothingCanBeWrittenTheViewerGoesOn) {
    std::ofstream(folder_.path() / "bonemill") << "a file where the folder should be";
    PreferenceKeeper keeper(file_);
    keeper.keep(kOthers, now_);
    EXPECT_NO_THROW(keeper.finish());
    EXPECT_EQ(keeper.kept(), Preferences());
}

TEST_F(Kept, AnotherUsersEyesReadNothing) {
    PreferenceKeeper keeper(file_);
    keeper.keep(kOthers, now_);
    keeper.finish();
    const auto others = std::filesystem::status(file_).permissions() & std::filesystem::perms::others_all;
    EXPECT_EQ(others, std::filesystem::perms::none);
    EXPECT_EQ(text().front(), '{');
}

}  // namespace
}  // namespace bonemill
