// What must hold of any data, and the edges: groups without spread, of one person, or wholly apart.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "haptic_server/teaching/study_statistics/effect_sizes.h"
#include "haptic_server/teaching/study_statistics/planning.h"
#include "haptic_server/teaching/study_statistics/rank_tests.h"
#include "haptic_server/teaching/study_statistics/reliability.h"

namespace bonemill::study {
namespace {

std::vector<double> likert(std::mt19937& random, size_t n) {
    std::vector<double> values(n);
    for (double& value : values) value = double(1 + random() % 5);
    return values;
}

// The slow, obvious way: every way of choosing who belongs to the first group.
RankTest byEnumeration(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> all = a;
    all.insert(all.end(), b.begin(), b.end());
    const double u = aucOf(a, b) * double(a.size() * b.size()), middle = double(a.size() * b.size()) / 2;
    double count = 0, far = 0, less = 0;
    for (unsigned chosen = 0; chosen < 1u << all.size(); ++chosen) {
        if (size_t(__builtin_popcount(chosen)) != a.size()) continue;
        std::vector<double> first, second;
        for (size_t i = 0; i < all.size(); ++i) (chosen >> i & 1 ? first : second).push_back(all[i]);
        const double other = aucOf(first, second) * double(a.size() * b.size());
        ++count;
        far += std::abs(other - middle) >= std::abs(u - middle) - 1e-9;
        less += other <= u + 1e-9;
    }
    return {u, far / count, less / count, kNotKnown, true};
}

TEST(StatisticsProperty, ExactMannWhitneyIsTheEnumeration) {
    std::mt19937 random(1);
    for (int i = 0; i < 40; ++i) {
        const auto a = likert(random, 2 + random() % 5), b = likert(random, 2 + random() % 5);
        const RankTest fast = mannWhitney(a, b), slow = byEnumeration(a, b);
        EXPECT_NEAR(fast.statistic, slow.statistic, 1e-12);
        EXPECT_NEAR(fast.p, slow.p, 1e-12);
        EXPECT_NEAR(fast.p_less, slow.p_less, 1e-12);
    }
}

TEST(StatisticsProperty, SwappingTheGroupsMirrorsEverything) {
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const auto a = likert(random, 2 + random() % 20), b = likert(random, 2 + random() % 20);
        const RankTest there = mannWhitney(a, b), back = mannWhitney(b, a);
        EXPECT_DOUBLE_EQ(there.statistic + back.statistic, double(a.size() * b.size()));
        EXPECT_NEAR(there.p, back.p, 1e-12);
        EXPECT_NEAR(there.p_less, back.p_greater, 1e-12);
        EXPECT_NEAR(cliffsDelta(aucOf(a, b)), -cliffsDelta(aucOf(b, a)), 1e-15);
        EXPECT_NEAR(aucOf(a, b), there.statistic / double(a.size() * b.size()), 1e-15);
        const TTest forth = welch(a, b), reverse = welch(b, a);
        if (!std::isnan(forth.p)) {
            EXPECT_NEAR(forth.p, reverse.p, 1e-12);
            EXPECT_NEAR(forth.interval.low, -reverse.interval.high, 1e-12);
        }
    }
}

TEST(StatisticsProperty, TheOrderOfPeopleDoesNotMatter) {
    std::mt19937 random(3);
    for (int i = 0; i < 50; ++i) {
        auto a = likert(random, 9), b = likert(random, 9);
        const double p = mannWhitney(a, b).p, g = hedgesG(a, b),
                     pratt = prattSignedRank(differencesOf(a, b)).p;
        std::vector<size_t> order(9);
        std::iota(order.begin(), order.end(), size_t(0));
        std::shuffle(order.begin(), order.end(), random);
        std::vector<double> c, d;
        for (const size_t j : order) {
            c.push_back(a[j]);
            d.push_back(b[j]);
        }
        EXPECT_DOUBLE_EQ(prattSignedRank(differencesOf(c, d)).p, pratt);
        std::shuffle(c.begin(), c.end(), random);
        EXPECT_DOUBLE_EQ(mannWhitney(c, d).p, p);
        EXPECT_NEAR(hedgesG(c, d), g, 1e-12);
    }
}

TEST(StatisticsProperty, RanksDoNotKnowTheScale) {
    std::mt19937 random(4);
    for (int i = 0; i < 50; ++i) {
        const auto a = likert(random, 7), b = likert(random, 6);
        auto c = a, d = b;
        for (double& x : c) x = std::exp(x);
        for (double& x : d) x = std::exp(x);
        EXPECT_DOUBLE_EQ(mannWhitney(a, b).p, mannWhitney(c, d).p);
    }
}

TEST(StatisticsProperty, HolmKeepsTheOrderAndNeverHelps) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 100; ++i) {
        std::vector<double> p(1 + random() % 20);
        for (double& one : p) one = share(random);
        const std::vector<double> adjusted = holm(p);
        for (size_t j = 0; j < p.size(); ++j) {
            EXPECT_GE(adjusted[j], p[j]);
            EXPECT_LE(adjusted[j], std::min(1.0, double(p.size()) * p[j]) + 1e-15);
            for (size_t k = 0; k < p.size(); ++k) EXPECT_TRUE(p[j] >= p[k] || adjusted[j] <= adjusted[k]);
        }
    }
}

TEST(StatisticsProperty, ATestWithoutAPIsNoTest) {
    const std::vector<double> adjusted = holm(std::vector<double>{0.02, kNotKnown, 0.04});
    EXPECT_DOUBLE_EQ(adjusted[0], 0.04);
    EXPECT_TRUE(std::isnan(adjusted[1]));
    EXPECT_DOUBLE_EQ(adjusted[2], 0.04);
}

TEST(StatisticsProperty, UnderNoDifferenceTheExactTestKeepsItsLevel) {
    std::mt19937 random(6);
    int alarms = 0;
    for (int i = 0; i < 4000; ++i) alarms += mannWhitney(likert(random, 6), likert(random, 6)).p <= 0.05;
    EXPECT_LE(alarms, 4000 * 0.05 + 3 * std::sqrt(4000 * 0.05 * 0.95));
}

TEST(StatisticsProperty, TheBootstrapIsTheSameForItsSeedAndHoldsTheValue) {
    std::mt19937 random(7);
    const auto a = likert(random, 13), b = likert(random, 8);
    const Interval first = bootstrapInterval(a, b, aucOf, 2011), again = bootstrapInterval(a, b, aucOf, 2011);
    EXPECT_EQ(first.low, again.low);
    EXPECT_EQ(first.high, again.high);
    EXPECT_LT(first.low, aucOf(a, b));
    EXPECT_GT(first.high, aucOf(a, b));
    EXPECT_GE(first.low, 0);
    EXPECT_LE(first.high, 1);
}

TEST(StatisticsProperty, TheBootstrapCoversTheTruth) {
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    int covered = 0;
    constexpr int kStudies = 200;
    for (int i = 0; i < kStudies; ++i) {
        std::vector<double> a(15), b(15);
        for (double& x : a) x = normal(random) + 0.7;
        for (double& x : b) x = normal(random);
        const Interval interval = bootstrapInterval(a, b, aucOf, uint64_t(i));
        const double truth = 0.6897;  // the normal distribution function of 0.7 / sqrt 2
        covered += interval.low <= truth && truth <= interval.high;
    }
    EXPECT_GE(covered, 0.88 * kStudies);
    EXPECT_LE(covered, 0.99 * kStudies);
}

TEST(StatisticsEdge, WhatSamplesCannotTellIsNotKnown) {
    const std::vector<double> none, one = {3}, same = {4, 4, 4, 4}, other = {4, 4, 4};
    EXPECT_TRUE(std::isnan(welch(one, same).p));
    EXPECT_TRUE(std::isnan(welch(same, other).p));
    EXPECT_TRUE(std::isnan(welch(none, one).p));
    EXPECT_TRUE(std::isnan(hedgesG(same, other)));
    EXPECT_TRUE(std::isnan(mannWhitney(none, one).p));
    EXPECT_DOUBLE_EQ(mannWhitney(same, other).p, 1);
    EXPECT_TRUE(std::isnan(prattSignedRank(std::vector<double>{0, 0}).p));
    EXPECT_TRUE(std::isnan(bootstrapInterval(same, other, hedgesG, 1).low));
    EXPECT_TRUE(std::isnan(cronbachsAlpha({{1, 2}})));
    EXPECT_TRUE(std::isnan(cohensKappa(same, same, KappaWeights::kNone)));
    EXPECT_TRUE(std::isnan(smallestDetectableD(1, 1, 0.05, 0.8)));
    EXPECT_TRUE(std::isnan(wilson(0, 0).low));
}

TEST(StatisticsEdge, GroupsWhollyApartHaveNoBootstrapInterval) {
    const std::vector<double> high = {5, 5, 4, 5}, low = {1, 2, 2};
    EXPECT_DOUBLE_EQ(cliffsDelta(aucOf(high, low)), 1);
    EXPECT_TRUE(std::isnan(bootstrapInterval(high, low, aucOf, 1).low));
}

}  // namespace
}  // namespace bonemill::study
