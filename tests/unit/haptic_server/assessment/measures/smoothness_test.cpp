#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "haptic_server/assessment/measures/strokes.h"

namespace bonemill {
namespace {

// The published example: exp(-5 t²) from -1 s to 1 s at 100 Hz.
std::vector<double> publishedSpeed() {
    std::vector<double> speed;
    for (int i = -100; i < 100; ++i) speed.push_back(std::exp(-5 * std::pow(i / 100.0, 2)));
    return speed;
}

TEST(Smoothness, ThePublishedExampleHasThePublishedValues) {
    EXPECT_NEAR(sparc(publishedSpeed(), 100), -1.41403, 5e-6);
    EXPECT_NEAR(logDimensionlessJerk(publishedSpeed(), 100), -5.81636, 5e-6);
}

TEST(Smoothness, SizeDoesNotMatter) {
    std::vector<double> doubled = publishedSpeed();
    for (double& value : doubled) value *= 2;
    EXPECT_NEAR(sparc(doubled, 100), sparc(publishedSpeed(), 100), 1e-12);
    EXPECT_NEAR(logDimensionlessJerk(doubled, 100), logDimensionlessJerk(publishedSpeed(), 100), 1e-12);
}

TEST(Smoothness, AMovementThatFaltersIsLessSmooth) {
    std::vector<double> faltering = publishedSpeed();
    for (size_t i = 0; i < faltering.size(); ++i)
        faltering[i] *= 1 + 0.5 * std::sin(2 * std::numbers::pi * 5 * double(i) / 100);
    EXPECT_LT(sparc(faltering, 100), sparc(publishedSpeed(), 100) - 0.2);
    EXPECT_LT(logDimensionlessJerk(faltering, 100), logDimensionlessJerk(publishedSpeed(), 100) - 1);
    EXPECT_GT(motionFrequency95(faltering, 100), motionFrequency95(publishedSpeed(), 100));
}

// Of exp(-5 t²) the power is exp(-w²/10): 95 % lie below the 1.96th part of its deviation.
TEST(Smoothness, TheFrequencyOfABellIsThatOfItsTransform) {
    const double deviation = std::sqrt(5.0) / (2 * std::numbers::pi);
    EXPECT_NEAR(motionFrequency95(publishedSpeed(), 100), 1.96 * deviation, 0.03);
}

TEST(Smoothness, WhatDoesNotMoveHasNoSmoothness) {
    const std::vector<double> still(50, 0.0);
    EXPECT_TRUE(std::isnan(sparc(still, 50)));
    EXPECT_TRUE(std::isnan(logDimensionlessJerk(still, 50)));
    EXPECT_TRUE(std::isnan(motionFrequency95(still, 50)));
    EXPECT_TRUE(std::isnan(sparc({}, 50)));
}

}  // namespace
}  // namespace bonemill
