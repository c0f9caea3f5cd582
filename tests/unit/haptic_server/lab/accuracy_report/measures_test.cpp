#include "haptic_server/lab/accuracy_report/measures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3d;

TickAnswer answer(const Vector3d& force, const Vector3d& torque = Vector3d::Zero(),
                  const Vector3d& position = Vector3d::Zero(), const Vector3d& turned = Vector3d::Zero()) {
    return {{position, expRotation(turned)}, {force, torque}};
}

Errors errorsOf(const std::vector<TickAnswer>& answers, const std::vector<TickAnswer>& truth) {
    ErrorSum sum;
    sum.add(answers, truth);
    return sum.errors();
}

TEST(Errors, EqualAnswersHaveNone) {
    const std::vector<TickAnswer> truth(5, answer({0, 3, 4}, {0.1, 0, 0}, {1e-3, 0, 0}, {0, 0.2, 0}));
    const Errors errors = errorsOf(truth, truth);
    EXPECT_EQ(errors.force, 0);
    EXPECT_EQ(errors.force_vector, 0);
    EXPECT_EQ(errors.torque, 0);
    EXPECT_NEAR(errors.direction, 0, 1e-12);
    EXPECT_EQ(errors.position, 0);
    EXPECT_NEAR(errors.rotation, 0, 1e-12);
    EXPECT_EQ(errors.ticks, 5u);
}

TEST(Errors, MagnitudeDirectionAndPoseAreToldApart) {
    const std::vector<TickAnswer> truth{answer({0, 0, 2}, {0, 0.01, 0})};
    // The force is 10 % longer and 30° off, the torque 20 % short; the tool is 3-4-5 µm beside and turned by
    // 2 mrad.
    const double angle = M_PI / 6;
    const std::vector<TickAnswer> answers{answer(2.2 * Vector3d(std::sin(angle), 0, std::cos(angle)),
                                                 {0.008, 0, 0}, {3e-6, 4e-6, 0}, {0, 0, 2e-3})};
    const Errors errors = errorsOf(answers, truth);
    EXPECT_NEAR(errors.force, 0.1, 1e-12);
    EXPECT_NEAR(errors.torque, 0.2, 1e-12);
    EXPECT_NEAR(errors.direction, angle, 1e-12);
    EXPECT_NEAR(errors.position, 5e-6, 1e-15);
    EXPECT_NEAR(errors.rotation, 2e-3, 1e-12);
    const double squared = 2.2 * 2.2 + 2 * 2 - 2 * 2.2 * 2 * std::cos(angle);
    EXPECT_NEAR(errors.force_vector, std::sqrt(squared) / 2, 1e-12);
}

TEST(Errors, TheWorstTickIsKnownBesideTheMean) {
    const std::vector<TickAnswer> truth(4, answer({0, 0, 2}));
    std::vector<TickAnswer> answers = truth;
    answers[2].hand_W.force.x() = 1;
    EXPECT_NEAR(errorsOf(answers, truth).force_vector, 0.25, 1e-12);
    EXPECT_NEAR(errorsOf(answers, truth).worst, 0.5, 1e-12);
}

TEST(Errors, AreRootMeanSquaresOverSeveralPathsRelativeToTheTruth) {
    ErrorSum sum;
    sum.add({answer({0, 0, 1.3})}, {answer({0, 0, 1})});
    sum.add({answer({0, 0, 2.6})}, {answer({0, 0, 3})});
    EXPECT_NEAR(sum.errors().force, std::sqrt((0.3 * 0.3 + 0.4 * 0.4) / (1 + 9)), 1e-12);
    EXPECT_EQ(sum.errors().ticks, 2u);
}

TEST(Errors, LightTouchesDoNotCount) {
    const double light = 0.99 * Errors::kFeltForce;
    const Errors errors =
        errorsOf({answer({0, 0, 50}), answer({1, 0, 0})}, {answer({0, 0, light}), answer({1, 0, 0})});
    EXPECT_EQ(errors.ticks, 1u);
    EXPECT_EQ(errors.force, 0);
    EXPECT_EQ(errorsOf({answer({0, 0, 50})}, {answer({0, 0, light})}).ticks, 0u);
}

TEST(Noise, StraightAndBentForcesAndAJump) {
    std::vector<TickAnswer> straight, bent;
    for (int n = 0; n < 50; ++n) {
        straight.push_back(answer({0.1 * n, -0.2 * n, 1}));
        bent.push_back(answer({0, 0, 0.5 * 3e-3 * n * n}));
    }
    NoiseSum none, constant, jump;
    none.add(straight);
    EXPECT_NEAR(none.noise(), 0, 1e-12);
    constant.add(bent);  // second difference: 3e-3 everywhere
    EXPECT_NEAR(constant.noise(), 3e-3, 1e-12);
    straight[20].hand_W.force.x() += 1;  // second differences 1, -2, 1
    jump.add(straight);
    EXPECT_NEAR(jump.noise(), std::sqrt(6.0 / 48), 1e-12);
}

TEST(Noise, DoesNotReachFromOnePathToTheNext) {
    NoiseSum noise;
    noise.add({answer({0, 0, 1}), answer({0, 0, 1})});
    noise.add({answer({0, 0, 7}), answer({0, 0, 7}), answer({0, 0, 7})});
    EXPECT_EQ(noise.noise(), 0);
}

// It is a spring from the origin, linear and torsional, felt exactly.
std::vector<TickAnswer> springAnswers(const std::vector<Pose>& device, double k, double k_rotation) {
    std::vector<TickAnswer> answers;
    for (const Pose& pose : device)
        answers.push_back({{}, {-k * pose.position, -k_rotation * logRotation(pose.rotation)}});
    return answers;
}

TEST(PathEnergy, ASpringStoresAndGivesBack) {
    std::vector<Pose> device;
    for (int n = 0; n <= 400; ++n) {
        const double stretch = 0.5 * (1 - std::cos(2 * M_PI * n / 400));
        device.push_back({{2e-3 * stretch, 1e-3 * stretch, 0}, expRotation({0, 0, 0.3 * stretch})});
    }
    const auto answers = springAnswers(device, 1000, 0.5);
    const PathEnergy whole = energyOf(answers, device);
    EXPECT_NEAR(whole.at_end, 0, 1e-12);
    EXPECT_NEAR(whole.lowest, 0, 1e-12);
    const PathEnergy half = energyOf({answers.begin(), answers.begin() + 201}, device);
    EXPECT_NEAR(half.at_end, 0.5 * 1000 * 5e-6 + 0.5 * 0.5 * 0.09, 1e-9);
}

TEST(PathEnergy, ForceThatLagsTakesAndForceThatLeadsGives) {
    std::vector<Pose> device;
    for (int n = 0; n <= 1000; ++n)
        device.push_back({{1e-3 * std::sin(2 * M_PI * n / 1000), 0, 0}, Eigen::Quaterniond::Identity()});
    const double rate = 2 * M_PI * 1e-3 / 1000;  // m per tick
    std::vector<TickAnswer> brake, motor;
    for (int n = 0; n <= 1000; ++n) {
        const double velocity = rate * std::cos(2 * M_PI * n / 1000);
        brake.push_back(answer({-1e3 * velocity, 0, 0}));
        motor.push_back(answer({1e3 * velocity, 0, 0}));
    }
    const double work = 1e3 * rate * rate * 1000 / 2;
    EXPECT_NEAR(energyOf(brake, device).at_end, work, 1e-3 * work);
    EXPECT_NEAR(energyOf(brake, device).lowest, 0, 1e-12);
    EXPECT_NEAR(energyOf(motor, device).at_end, -work, 1e-3 * work);
    EXPECT_NEAR(energyOf(motor, device).lowest, -work, 1e-3 * work);
}

TEST(TimedRun, KeepsTheShortestAndTheLongestTimes) {
    RunRecords first(3), second(3);
    first[0].compute_ns = 10, first[1].compute_ns = 500, first[2].compute_ns = 12;
    second[0].compute_ns = 11, second[1].compute_ns = 9, second[2].compute_ns = 900;
    TimedRun run(first);
    run.add(second);
    EXPECT_EQ(run.records[0].compute_ns, 10);
    EXPECT_EQ(run.records[1].compute_ns, 9);
    EXPECT_EQ(run.records[2].compute_ns, 12);
    EXPECT_EQ(run.longest_ns, (std::vector<int64_t>{11, 500, 900}));
}

}  // namespace
}  // namespace bonemill
