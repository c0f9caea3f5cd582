#include "haptic_server/assessment/measures/motion.h"

#include <gtest/gtest.h>

#include "tests/unit/haptic_server/assessment/measures/hand_made_session.h"

namespace bonemill {
namespace {

using test::HandMadeSession;
using test::kPi;

std::vector<MotionSample> samplesOf(const HandMadeSession& session) {
    std::vector<MotionSample> samples;
    Motion motion([&](const MotionSample& sample) { samples.push_back(sample); });
    double last_s = -1;
    session.play([&](const TickRecord& record) {
        const double since = record.t_s - last_s;
        motion.add({record, last_s < 0 || since > 0.1 ? 0 : since});
        last_s = record.t_s;
    });
    motion.finish();
    return samples;
}

// Of a sine, away from both ends.
double amplitudeAt(double hertz) {
    HandMadeSession session;
    session.seconds = 4;
    session.place = [=](double t) { return Eigen::Vector3d(std::sin(2 * kPi * hertz * t), 0, 0); };
    double squared = 0;
    int count = 0;
    for (const MotionSample& sample : samplesOf(session)) {
        if (sample.t < 0.5 || sample.t > 3.5) continue;
        squared += sample.p_W.x() * sample.p_W.x();
        ++count;
    }
    return std::sqrt(2 * squared / count);
}

TEST(Motion, PassesTheHandAndKeepsTremorOut) {
    EXPECT_NEAR(amplitudeAt(1), 1, 0.01);
    EXPECT_NEAR(amplitudeAt(4.7), 1, 0.02);
    EXPECT_NEAR(amplitudeAt(10), 0.5, 0.03);
    EXPECT_LT(amplitudeAt(16.3), 0.02);
    EXPECT_LT(amplitudeAt(40.7), 0.01);
    EXPECT_LT(amplitudeAt(123), 0.01);
}

TEST(Motion, ComesAtFiftyHertzAndInPhase) {
    HandMadeSession session;
    session.seconds = 4;
    session.place = [](double t) { return Eigen::Vector3d(std::sin(2 * kPi * 2 * t), 0, 0); };
    const std::vector<MotionSample> samples = samplesOf(session);
    EXPECT_NEAR(double(samples.size()), 200, 1);
    for (size_t i = 20; i + 20 < samples.size(); ++i) {
        EXPECT_NEAR(samples[i].t - samples[i - 1].t, 0.02, 1e-9);
        EXPECT_TRUE(samples[i].follows);
        EXPECT_NEAR(samples[i].p_W.x(), std::sin(2 * kPi * 2 * samples[i].t), 0.02);
    }
}

TEST(Motion, DoesNotFollowAcrossLostTime) {
    HandMadeSession session;
    session.seconds = 2;
    session.place = [](double t) { return Eigen::Vector3d(t < 1 ? 0 : 1, 0, 0); };
    std::vector<MotionSample> samples;
    Motion motion([&](const MotionSample& sample) { samples.push_back(sample); });
    double last_s = -1;
    session.play([&](const TickRecord& record) {
        if (record.t_s > 0.7 && record.t_s < 1.3) return;
        const double since = record.t_s - last_s;
        motion.add({record, last_s < 0 || since > 0.1 ? 0 : since});
        last_s = record.t_s;
    });
    motion.finish();
    int breaks = 0;
    for (const MotionSample& sample : samples) {
        breaks += sample.follows ? 0 : 1;
        EXPECT_NEAR(sample.p_W.x(), sample.t < 1 ? 0 : 1, 1e-9);
    }
    EXPECT_EQ(breaks, 2) << "the first sample, and that after the gap";
}

TEST(Motion, NothingThatWasRemovedGetsLost) {
    HandMadeSession session;
    session.seconds = 1.234;
    session.removed_until = [](double t) { return 1e-9 * t * t; };
    double removed = 0;
    for (const MotionSample& sample : samplesOf(session)) removed += sample.removed;
    EXPECT_NEAR(removed, 1e-9 * 1.234 * 1.234, 1e-15);
}

}  // namespace
}  // namespace bonemill
