// A session that has a server refuses the second before that one has shown anything.
#include <gtest/gtest.h>

#include "haptic_server/server/publish/publisher.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

TEST(SecondServer, IsRefusedBeforeItShowsAnything) {
    const test::TemporaryFolder folder;
    const auto made = test::run({"make_phantom", "body", "--kind", "sphere", "--out", folder / "ball.nrrd"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    test::writeFile(folder / "scene.textproto", "volume { path: \"ball.nrrd\" }");
    SceneSubscriber viewer({.domain = testDomain(), .session = testSession(), .name = "viewer"});
    Publisher first({.domain = testDomain(), .session = testSession()});
    topics::Status status;
    status.set_scene("first");
    ASSERT_TRUE(first.publishStatus(status));
    const auto second = test::run({"haptic_server", "--scene", folder / "scene.textproto", "--domain",
                                   std::to_string(testDomain()), "--session", std::to_string(testSession()),
                                   "--seconds", "1"});
    EXPECT_EQ(second.exit_code, 2) << second.err;
    EXPECT_NE(second.err.find("has a server already, with the scene 'first'"), std::string::npos)
        << second.err;
    viewer.poll();
    EXPECT_TRUE(viewer.status());
    EXPECT_FALSE(viewer.sceneInfo()) << "only the second has one";
}

}  // namespace
}  // namespace bonemill
