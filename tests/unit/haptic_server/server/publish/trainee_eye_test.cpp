#include "haptic_server/server/publish/trainee_eye.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

using namespace std::chrono_literals;

topics::Viewer viewerOf(uint64_t sender, topics::Viewer::Role role, double x) {
    topics::Viewer viewer;
    viewer.set_sender(sender);
    viewer.set_role(role);
    for (const double p : {x, 0.2, 0.3}) viewer.mutable_eye()->add_p_wc_m(p);
    for (const double q : {1.0, 0.0, 0.0, 0.0}) viewer.mutable_eye()->add_q_wc(q);
    viewer.mutable_eye()->set_field_of_view_rad(0.5);
    return viewer;
}

class TraineeEyeTest : public testing::Test {
  protected:
    bool hear(const topics::Viewer& viewer, std::optional<topics::Viewer::Role> proven = {}) {
        const std::string bytes = viewer.SerializeAsString();
        return eye_.hear({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, viewer.sender(),
                         viewer.sender() + 100, proven, now_);
    }
    // The x of the eye that counts; nothing if there is no new one.
    std::optional<double> x() {
        const auto seen = eye_.takeChanged(now_);
        return seen ? std::optional(seen->X_WC.position.x()) : std::nullopt;
    }

    TraineeEye eye_;
    TraineeEye::Clock::time_point now_{1h};
};

constexpr auto kOperator = topics::Viewer::OPERATOR, kInstructor = topics::Viewer::INSTRUCTOR,
               kViewer = topics::Viewer::VIEWER;

TEST_F(TraineeEyeTest, TheOnlyOperatorsCountsAndIsToldWhenItChanges) {
    EXPECT_EQ(x(), std::nullopt);
    EXPECT_TRUE(hear(viewerOf(1, kOperator, 0.1)));
    EXPECT_EQ(x(), 0.1);
    EXPECT_EQ(x(), std::nullopt);
    hear(viewerOf(1, kOperator, 0.1));
    EXPECT_EQ(x(), std::nullopt) << "the same again";
    hear(viewerOf(1, kOperator, 0.15));
    EXPECT_EQ(x(), 0.15);
}

TEST_F(TraineeEyeTest, WhoOnlyLooksOrTeachesDoesNotCount) {
    EXPECT_TRUE(hear(viewerOf(1, kViewer, 0.1)));
    EXPECT_TRUE(hear(viewerOf(2, kInstructor, 0.1)));
    topics::Viewer named = viewerOf(3, kViewer, 0.1);
    named.set_is_trainee(true);
    EXPECT_TRUE(hear(named)) << "it names itself";
    EXPECT_EQ(x(), std::nullopt);
}

TEST_F(TraineeEyeTest, OfTwoOperatorsNoneCountsUntilOneIsNamedOrGone) {
    hear(viewerOf(1, kOperator, 0.1));
    hear(viewerOf(2, kOperator, 0.2));
    EXPECT_EQ(x(), std::nullopt);
    topics::Viewer named = viewerOf(2, kOperator, 0.2);
    named.set_is_trainee(true);
    hear(named);
    EXPECT_EQ(x(), 0.2);
    topics::Viewer also_named = viewerOf(3, kInstructor, 0.3);
    also_named.set_is_trainee(true);
    hear(also_named);
    hear(viewerOf(1, kOperator, 0.11));
    EXPECT_EQ(x(), std::nullopt) << "the first one that was named keeps it";
    now_ += TraineeEye::kTimeout + 1s;
    hear(viewerOf(1, kOperator, 0.12));
    EXPECT_EQ(x(), 0.12) << "it is the only one again";
}

TEST_F(TraineeEyeTest, AViewerWithoutAnEyeDisturbsNobody) {
    topics::Viewer blind;
    blind.set_sender(9);
    blind.set_role(kOperator);
    hear(blind);
    hear(viewerOf(1, kOperator, 0.1));
    EXPECT_EQ(x(), 0.1);
}

TEST_F(TraineeEyeTest, TheCertificateCountsAndNotTheWord) {
    EXPECT_TRUE(hear(viewerOf(1, kOperator, 0.1), kViewer));
    EXPECT_EQ(x(), std::nullopt);
    EXPECT_TRUE(hear(viewerOf(1, kViewer, 0.1), kOperator));
    EXPECT_EQ(x(), 0.1);
}

TEST_F(TraineeEyeTest, NobodySpeaksForAnother) {
    hear(viewerOf(1, kOperator, 0.1));
    const std::string bytes = viewerOf(1, kOperator, 0.4).SerializeAsString();
    const std::span payload{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
    eye_.hear(payload, 1, 7, {}, now_);
    EXPECT_EQ(x(), 0.1);
    EXPECT_FALSE(eye_.hear(payload, 2, 7, {}, now_)) << "the envelope has another sender";
}

TEST_F(TraineeEyeTest, WhatMakesNoSenseIsRefused) {
    const auto refused = [&](auto&& change) {
        topics::Viewer viewer = viewerOf(1, kOperator, 0.1);
        change(viewer);
        return !hear(viewer);
    };
    EXPECT_TRUE(refused([](auto& v) { v.set_sender(0); }));
    EXPECT_TRUE(
        refused([](auto& v) { v.mutable_eye()->set_p_wc_m(1, std::numeric_limits<double>::infinity()); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->set_p_wc_m(1, 1e4); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->add_p_wc_m(1); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->set_q_wc(0, 0.5); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->set_q_wc(0, std::nan("")); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->set_field_of_view_rad(0); }));
    EXPECT_TRUE(refused([](auto& v) { v.mutable_eye()->set_field_of_view_rad(4); }));
    EXPECT_TRUE(refused([](auto& v) { v.set_name(std::string(5000, 'x')); }));
    EXPECT_FALSE(refused([](auto&) {}));
}

}  // namespace
}  // namespace bonemill
