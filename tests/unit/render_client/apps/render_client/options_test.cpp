#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/base/user_error.h"
#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {
namespace {

std::optional<ClientOptions> parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "render_client");
    return parseOptions(int(arguments.size()), arguments.data());
}

TEST(Options, AWindowByDefault) {
    const auto options = parse({});
    ASSERT_TRUE(options);
    EXPECT_FALSE(options->offscreen);
    EXPECT_EQ(options->width, 1280);
    EXPECT_EQ(options->height, 800);
    EXPECT_FALSE(options->view.target_W);
}

TEST(Options, AWindowWithoutASessionChoosesOne) {
    EXPECT_TRUE(parse({})->chooses_session);
    EXPECT_TRUE(soughtOf(*parse({})).is_any_session);
    EXPECT_FALSE(parse({"--session", "1"})->chooses_session);
    EXPECT_FALSE(parse({"--offscreen", "--out", "pictures"})->chooses_session);
    EXPECT_FALSE(parse({"--command", "pause"})->chooses_session);
    EXPECT_TRUE(parse({"--list", "--domain", "3"})->lists_sessions);
    EXPECT_THROW(parse({"--list", "--session", "3"}), UserError);
}

TEST(Options, ANameOfOnesOwnAndTheRoleOfAnOperator) {
    const auto options = parse({});
    ASSERT_TRUE(options);
    EXPECT_FALSE(options->subscriber.name.empty());
    EXPECT_EQ(options->subscriber.role, topics::Viewer::OPERATOR);
    const auto teacher = parse({"--name", "Anna B", "--role", "instructor"});
    ASSERT_TRUE(teacher);
    EXPECT_EQ(teacher->subscriber.name, "Anna B");
    EXPECT_EQ(teacher->subscriber.role, topics::Viewer::INSTRUCTOR);
    EXPECT_EQ(parse({"--role", "viewer"})->subscriber.role, topics::Viewer::VIEWER);
    for (const char* profile : {"lab", "classroom"}) {
        EXPECT_EQ(parse({"--profile", profile})->subscriber.role, topics::Viewer::VIEWER);
        EXPECT_EQ(parse({"--profile", profile, "--command", "accuracy fast"})->subscriber.role,
                  topics::Viewer::VIEWER);
        EXPECT_EQ(parse({"--profile", profile, "--role", "operator"})->subscriber.role,
                  topics::Viewer::OPERATOR);
    }
    EXPECT_EQ(parse({"--profile", "one-pc"})->subscriber.role, topics::Viewer::OPERATOR);
    for (const char* role : {"boss", "7", ""}) EXPECT_THROW(parse({"--role", role}), UserError) << role;
}

TEST(Options, OffscreenWithUnitsConverted) {
    const auto options = parse({"--offscreen",
                                "--frames",
                                "3",
                                "--out",
                                "pictures",
                                "--size",
                                "640x480",
                                "--interval-ms",
                                "250",
                                "--wait-complete",
                                "--domain",
                                "7",
                                "--session",
                                "9",
                                "--camera-azimuth-deg",
                                "-90",
                                "--camera-elevation-deg",
                                "45",
                                "--camera-distance-mm",
                                "120",
                                "--camera-target-mm",
                                "-1",
                                "2.5",
                                "-30"});
    ASSERT_TRUE(options && options->offscreen);
    EXPECT_EQ(options->offscreen->frames, 3u);
    EXPECT_EQ(options->offscreen->directory, "pictures");
    EXPECT_EQ(options->offscreen->interval, std::chrono::milliseconds(250));
    EXPECT_TRUE(options->offscreen->wait_complete);
    EXPECT_EQ(options->width, 640);
    EXPECT_EQ(options->height, 480);
    EXPECT_EQ(options->subscriber.domain, 7u);
    EXPECT_EQ(options->subscriber.session, 9u);
    EXPECT_NEAR(options->view.azimuth.value(), -M_PI / 2, 1e-12);
    EXPECT_NEAR(options->view.elevation.value(), M_PI / 4, 1e-12);
    EXPECT_NEAR(options->view.distance.value(), 0.12, 1e-12);
    EXPECT_TRUE(options->view.target_W.value().isApprox(Eigen::Vector3d(-0.001, 0.0025, -0.03)));
}

TEST(Options, TheNetwork) {
    const auto options =
        parse({"--profile", "lab", "--interface", "eth0", "--peer", "10.0.0.1", "--peer", "pc2"});
    ASSERT_TRUE(options);
    EXPECT_EQ(options->network.profile, "lab");
    EXPECT_EQ(options->network.interface, "eth0");
    EXPECT_EQ(options->network.peers, (std::vector<std::string>{"10.0.0.1", "pc2"}));
    EXPECT_EQ(parse({})->network.profile, "");
}

TEST(Options, ACommandIsAModeOfItsOwn) {
    const auto options = parse({"--command", "tool fine burr", "--session", "9"});
    ASSERT_TRUE(options && options->command);
    EXPECT_EQ(options->command->text, "tool fine burr");
    EXPECT_EQ(options->command->timeout, std::chrono::seconds(60));
    EXPECT_EQ(options->subscriber.session, 9u);
    EXPECT_FALSE(options->offscreen);
    EXPECT_EQ(parse({"--command", "reset", "--timeout-s", "3"})->command->timeout, std::chrono::seconds(3));
    EXPECT_FALSE(parse({})->command);
}

TEST(Options, TheServerThatIsSoughtIsNamed) {
    const ServerSought sought =
        soughtOf(*parse({"--session", "4", "--domain", "2", "--profile", "lab", "--interface", "eth0"}));
    EXPECT_EQ(sought.session, 4u);
    EXPECT_EQ(sought.domain, 2u);
    EXPECT_EQ(sought.profile, "lab");
    EXPECT_EQ(sought.interface, "eth0");
    EXPECT_TRUE(sought.is_on_lan);
    EXPECT_FALSE(soughtOf(*parse({})).is_on_lan);
}

TEST(Options, WhatIsShownAtTheStart) {
    const ViewSettings plain = parse({})->settings;
    EXPECT_FALSE(plain.cuts[0].is_on || plain.cuts[1].is_on || plain.cuts[2].is_on);
    EXPECT_FALSE(plain.is_transparent);
    EXPECT_TRUE(plain.show_hud);
    const ViewSettings all =
        parse({"--cut-x", "0.25", "--cut-z", "0.5", "--flip-z", "--transparent", "0.2", "--stereo",
               "anaglyph", "--camera", "endoscope", "--no-hud", "--text-scale", "2"})
            ->settings;
    EXPECT_TRUE(all.cuts[0].is_on && !all.cuts[1].is_on && all.cuts[2].is_on);
    EXPECT_DOUBLE_EQ(all.cuts[0].position, 0.25);
    EXPECT_FALSE(all.cuts[0].is_flipped);
    EXPECT_TRUE(all.cuts[2].is_flipped);
    EXPECT_TRUE(all.is_transparent);
    EXPECT_DOUBLE_EQ(all.opacity, 0.2);
    EXPECT_EQ(all.stereo, StereoMode::kAnaglyph);
    EXPECT_EQ(all.camera, CameraMode::kEndoscope);
    EXPECT_FALSE(all.show_hud);
    EXPECT_EQ(plain.text_scale, 1);
    EXPECT_EQ(all.text_scale, 2);
    EXPECT_THROW(parse({"--text-scale", "9"}), UserError);
    EXPECT_FALSE(plain.has_depth_of_field);
    const ViewSettings microscope = parse({"--camera", "microscope", "--depth-of-field"})->settings;
    EXPECT_EQ(microscope.camera, CameraMode::kMicroscope);
    EXPECT_TRUE(microscope.has_depth_of_field);
    EXPECT_EQ(parse({"--stereo", "side-by-side"})->settings.stereo, StereoMode::kSideBySide);
    const ViewSettings by_default = parse({"--transparent"})->settings;
    EXPECT_TRUE(by_default.is_transparent);
    EXPECT_DOUBLE_EQ(by_default.opacity, ViewSettings::kDefaultOpacity);
    EXPECT_TRUE(parse({"--transparent", "--offscreen", "--out", "p"})->offscreen);
}

TEST(Options, WhatIsShownOfTheScanAtTheStart) {
    const SliceSettings plain = parse({})->settings.slices;
    EXPECT_FALSE(plain.are_shown || plain.window);
    EXPECT_EQ(plain.ct, CtShown::kOnCuts);
    const SliceSettings all =
        parse({"--slices", "--scan-on", "milled", "--grey-window", "2000", "-500"})->settings.slices;
    EXPECT_TRUE(all.are_shown);
    EXPECT_EQ(all.ct, CtShown::kOnCutsAndMilled);
    EXPECT_EQ(all.window, (GreyWindow{2000, -500}));
    EXPECT_EQ(parse({"--scan-on", "off"})->settings.slices.ct, CtShown::kNowhere);
    EXPECT_EQ(parse({"--scan-on", "materials"})->settings.slices.ct, CtShown::kMaterialsOnCuts);
    EXPECT_GT(parse({"--grey-window", "-5", "0"})->settings.slices.window->width, 0);
    EXPECT_THROW(parse({"--scan-on", "walls"}), UserError);
    EXPECT_THROW(parse({"--grey-window", "2000"}), UserError);
    EXPECT_THROW(parse({"--command", "reset", "--slices"}), UserError);
}

TEST(Options, StructuresAreSeenAsAskedFor) {
    const auto modes = [](const std::vector<const char*>& options) {
        return parse(options)->settings.structures;
    };
    for (const StructureMode mode : modes({})) EXPECT_EQ(mode, StructureMode::kExposedOnly);
    for (const StructureMode mode : modes({"--structures", "through-bone"}))
        EXPECT_EQ(mode, StructureMode::kThroughBone);
    for (const StructureMode mode : modes({"--structures", "off"})) EXPECT_EQ(mode, StructureMode::kOff);
    EXPECT_FALSE(parse({})->settings.show_thickness);
    EXPECT_TRUE(parse({"--thickness"})->settings.show_thickness);
    EXPECT_THROW(parse({"--structures", "red"}), UserError);
}

TEST(Options, RefusesViewsThatMakeNoSense) {
    EXPECT_THROW(parse({"--cut-x"}), UserError);
    EXPECT_THROW(parse({"--cut-x", "1.5"}), UserError);
    EXPECT_THROW(parse({"--cut-y", "-0.5"}), UserError);
    EXPECT_THROW(parse({"--flip-y"}), UserError);
    EXPECT_THROW(parse({"--cut-x", "0.5", "--flip-y"}), UserError);
    EXPECT_THROW(parse({"--transparent", "2"}), UserError);
    EXPECT_THROW(parse({"--transparent", "0.2", "0.3"}), UserError);
    EXPECT_THROW(parse({"--stereo", "cross-eyed"}), UserError);
    EXPECT_THROW(parse({"--camera", "fly"}), UserError);
    for (const char* view : {"--transparent", "--no-hud"})
        EXPECT_THROW(parse({"--command", "reset", view}), UserError) << view;
    EXPECT_THROW(parse({"--command", "reset", "--cut-x", "0.5"}), UserError);
    EXPECT_THROW(parse({"--command", "reset", "--camera", "orbit"}), UserError);
}

TEST(Options, TheMouseHoldsTheToolOnRequest) {
    EXPECT_FALSE(parse({})->holds_tool);
    EXPECT_TRUE(parse({"--hold-tool"})->holds_tool);
}

TEST(Options, RefusesWhatMakesNoSense) {
    EXPECT_THROW(parse({"--command"}), UserError);
    EXPECT_THROW(parse({"--command", ""}), UserError);
    EXPECT_THROW(parse({"--command", "explode"}), UserError);
    EXPECT_THROW(parse({"--command", "restore \xff"}), UserError);
    EXPECT_THROW(parse({"--command", "reset", "--offscreen", "--out", "p"}), UserError);
    EXPECT_THROW(parse({"--hold-tool", "--offscreen", "--out", "p"}), UserError);
    EXPECT_THROW(parse({"--hold-tool", "--role", "viewer"}), UserError);
    EXPECT_THROW(parse({"--timeout-s", "3"}), UserError);
    EXPECT_THROW(parse({"--bogus"}), UserError);
    EXPECT_THROW(parse({"--offscreen"}), UserError);
    EXPECT_THROW(parse({"--frames", "2"}), UserError);
    EXPECT_THROW(parse({"--offscreen", "--out", "p", "--frames", "0"}), UserError);
    EXPECT_THROW(parse({"--offscreen", "--out", "p", "--frames", "many"}), UserError);
    EXPECT_THROW(parse({"--domain", "231"}), UserError);
    EXPECT_THROW(parse({"--camera-elevation-deg", "91"}), UserError);
    EXPECT_THROW(parse({"--camera-distance-mm", "-5"}), UserError);
    EXPECT_THROW(parse({"--camera-target-mm", "1", "2"}), UserError);
    for (const char* size : {"12x", "640", "640x480x2", "10x10", "99999x10", "-640x480", "axb", "640x480 "}) {
        EXPECT_THROW(parse({"--size", size}), UserError) << size;
    }
}

}  // namespace
}  // namespace bonemill
