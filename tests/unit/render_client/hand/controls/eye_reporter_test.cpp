#include <gtest/gtest.h>

#include "render_client/hand/controls/announcing.h"

namespace bonemill {
namespace {

using std::chrono::milliseconds;

// How often it is due in a second in which the camera is asked about every ms.
int countDue(EyeReporter& watch, EyeReporter::Clock::time_point& now, Camera& camera, double moved_per_ms) {
    int count = 0;
    for (int ms = 0; ms < 1000; ++ms) {
        now += milliseconds(1);
        camera.eye_W.x() += moved_per_ms;
        if (!watch.isDue(now, camera)) continue;
        watch.told(now, camera);
        ++count;
    }
    return count;
}

TEST(EyeReporter, TellsTwentyTimesPerSecondWhatMovesAndOnceWhatRests) {
    EyeReporter watch;
    EyeReporter::Clock::time_point now;
    Camera camera;
    EXPECT_EQ(countDue(watch, now, camera, 0), 1);
    EXPECT_EQ(countDue(watch, now, camera, 1e-3), 20);
    EXPECT_LE(countDue(watch, now, camera, 0), 1) << "where it came to rest";
    EXPECT_EQ(countDue(watch, now, camera, 0), 0) << "what it told last is what it sees";
    EXPECT_NEAR(countDue(watch, now, camera, 1e-6), 10, 1) << "1 mm per s, told every 0.1 mm";
}

TEST(EyeReporter, TellsOfATurnAndOfAnotherAngleOfView) {
    EyeReporter watch;
    EyeReporter::Clock::time_point now;
    Camera camera;
    watch.told(now, camera);
    now += EyeReporter::kPeriod;
    EXPECT_FALSE(watch.isDue(now, camera));
    Camera turned = camera;
    turned.R_WC = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()).toRotationMatrix();
    EXPECT_TRUE(watch.isDue(now, turned));
    Camera wider = camera;
    wider.field_of_view += 0.01;
    EXPECT_TRUE(watch.isDue(now, wider));
}

TEST(EyeReporter, TheMessageHasTheCamerasPose) {
    Camera camera;
    camera.eye_W = {0.1, 0.2, 0.3};
    camera.R_WC = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const topics::Eye eye = eyeOf(camera);
    ASSERT_EQ(eye.p_wc_m_size(), 3);
    ASSERT_EQ(eye.q_wc_size(), 4);
    const Eigen::Quaterniond q(eye.q_wc(0), eye.q_wc(1), eye.q_wc(2), eye.q_wc(3));
    EXPECT_NEAR((q.toRotationMatrix() - camera.R_WC).norm(), 0, 1e-12);
    EXPECT_EQ(eye.p_wc_m(2), 0.3);
    EXPECT_EQ(eye.field_of_view_rad(), camera.field_of_view);
}

}  // namespace
}  // namespace bonemill
