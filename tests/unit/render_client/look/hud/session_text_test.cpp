#include <gtest/gtest.h>

#include <limits>

#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

TEST(SessionText, RolesHaveNames) {
    EXPECT_EQ(roleName(topics::Viewer::VIEWER), "viewer");
    EXPECT_EQ(roleName(topics::Viewer::OPERATOR), "operator");
    EXPECT_EQ(roleName(topics::Viewer::INSTRUCTOR), "instructor");
    EXPECT_EQ(roleName(topics::Viewer::EXAMINER), "examiner");
    EXPECT_EQ(roleName(topics::Viewer::Role(7)), "?") << "nobody is called a viewer by mistake";
}

TEST(SessionText, AWatcherIsNamedWithItsLink) {
    topics::Viewer watcher;
    watcher.set_role(topics::Viewer::EXAMINER);
    watcher.set_frame_rate_hz(30);
    watcher.set_is_complete(true);
    EXPECT_EQ(watcherText(watcher), "examiner, 30 Hz");
    watcher.set_link("browser");
    EXPECT_EQ(watcherText(watcher), "examiner by browser, 30 Hz");
}

TEST(SessionText, AClockIsBoundedWhateverTheNetworkSays) {
    EXPECT_EQ(clockText(0), "0:00:00");
    EXPECT_EQ(clockText(3725.9), "1:02:05");
    EXPECT_EQ(clockText(1e300), clockText(1e9));
    EXPECT_EQ(clockText(-1), "\u2013");
    EXPECT_EQ(clockText(std::numeric_limits<double>::quiet_NaN()), "\u2013");
    EXPECT_EQ(clockText(std::numeric_limits<double>::infinity()), "\u2013");
}

}  // namespace
}  // namespace bonemill
