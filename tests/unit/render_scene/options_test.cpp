#include "render_client/app/options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/config/user_error.h"

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
    EXPECT_FALSE(options->view.target);
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
    EXPECT_TRUE(options->view.target.value().isApprox(Eigen::Vector3d(-0.001, 0.0025, -0.03)));
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

TEST(Options, RefusesWhatMakesNoSense) {
    EXPECT_THROW(parse({"--command"}), UserError);
    EXPECT_THROW(parse({"--command", ""}), UserError);
    EXPECT_THROW(parse({"--command", "explode"}), UserError);
    EXPECT_THROW(parse({"--command", "restore \xff"}), UserError);
    EXPECT_THROW(parse({"--command", "reset", "--offscreen", "--out", "p"}), UserError);
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
