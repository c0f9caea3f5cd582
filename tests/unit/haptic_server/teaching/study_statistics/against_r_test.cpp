// Every figure of the statistics against R 4.2.2 and its packages coin, exactRankTests and boot.
#include <gtest/gtest.h>

#include "haptic_server/teaching/study_statistics/effect_sizes.h"
#include "haptic_server/teaching/study_statistics/planning.h"
#include "haptic_server/teaching/study_statistics/rank_tests.h"
#include "haptic_server/teaching/study_statistics/reliability.h"
#include "tests/unit/haptic_server/teaching/study_statistics/r_values.h"

namespace bonemill::study {
namespace {

using test::rValues;

constexpr double kTolerance = 1e-9;

void expectAll(const std::vector<double>& ours, const std::string& name) {
    const std::vector<double>& r = rValues(name);
    ASSERT_EQ(ours.size(), r.size()) << name;
    for (size_t i = 0; i < r.size(); ++i)
        EXPECT_NEAR(ours[i], r[i], kTolerance * std::max(1.0, std::abs(r[i]))) << name << ", number " << i;
}

std::vector<double> of(const TTest& test) {
    return {test.t, test.df, test.p, test.interval.low, test.interval.high};
}

std::vector<double> of(const RankTest& test) {
    return {test.statistic, test.p, test.p_less, test.p_greater};
}

Table tableOf(const std::vector<double>& values, size_t columns) {
    Table table;
    for (size_t i = 0; i < values.size(); i += columns)
        table.emplace_back(values.begin() + long(i), values.begin() + long(i + columns));
    return table;
}

class TwoGroups : public testing::TestWithParam<const char*> {
  protected:
    const std::string name = GetParam();
    const std::vector<double>& a = rValues(name + ".a");
    const std::vector<double>& b = rValues(name + ".b");
};

TEST_P(TwoGroups, WelchIsTTestOfR) {
    expectAll(of(welch(a, b)), name + ".welch");
}

TEST_P(TwoGroups, MannWhitneyIsThatOfCoinAndExactRankTests) {
    const RankTest test = mannWhitney(a, b);
    EXPECT_EQ(test.is_exact, a.size() + b.size() <= kMaxExact);
    expectAll(of(test), name + ".mann_whitney");
}

TEST_P(TwoGroups, EffectSizes) {
    expectAll({cohensD(a, b), hedgesG(a, b), cliffsDelta(aucOf(a, b)), aucOf(a, b)}, name + ".effects");
}

INSTANTIATE_TEST_SUITE_P(R, TwoGroups,
                         testing::Values("likert_13_8", "likert_13_8_alike", "normal_13_8", "normal_5_7",
                                         "likert_30_25", "apart_4_3", "smallest_2_2", "likert_70_60"));

class Paired : public testing::TestWithParam<const char*> {};

TEST_P(Paired, PairedTAndPratt) {
    const std::string name = GetParam();
    const std::vector<double>&a = rValues(name + ".a"), &b = rValues(name + ".b");
    expectAll(of(pairedT(a, b)), name + ".paired_t");
    expectAll(of(prattSignedRank(differencesOf(a, b))), name + ".pratt");
}

INSTANTIATE_TEST_SUITE_P(R, Paired, testing::Values("likert_12", "normal_9", "likert_120"));

TEST(AgainstR, BcaIntervalIsThatOfBoot) {
    for (const int level : {90, 95}) {
        const Interval interval = bcaInterval(rValues("bca.replicates"), rValues("bca.observed")[0],
                                              rValues("bca.influence"), level / 100.0);
        expectAll({interval.low, interval.high}, "bca.interval_" + std::to_string(level));
    }
}

TEST(AgainstR, Holm) {
    expectAll(holm(rValues("holm.p")), "holm.adjusted");
}

TEST(AgainstR, Planning) {
    expectAll({falseAlarmChance(16, 0.05)}, "false_alarm_16");
    expectAll({powerOfTTest(0, 13, 8, 0.05)}, "power.d_0");
    expectAll({powerOfTTest(0.5, 13, 8, 0.05)}, "power.d_0.5");
    expectAll({powerOfTTest(1.35, 13, 8, 0.05)}, "power.d_1.35");
    expectAll({powerOfTTest(3, 13, 8, 0.05)}, "power.d_3");
    expectAll({smallestDetectableD(13, 8, 0.05, 0.8)}, "power.smallest_13_8");
    expectAll({smallestDetectableD(30, 30, 0.05, 0.9)}, "power.smallest_30_30");
    expectAll({smallestDetectableD(13, 8, 0.05 / 16, 0.8)}, "power.smallest_13_8_holm");
    expectAll({double(neededPerGroup(0.5, 0.05, 0.8))}, "power.needed_half");
}

TEST(AgainstR, WhatTheThesisPrints) {
    const double d = impliedD(0.04, 13, 8);
    const Interval interval = intervalOfD(d, 13, 8);
    expectAll({d, interval.low, interval.high}, "thesis.implied_d");
    const std::vector<std::pair<size_t, size_t>> shares = {{13, 21}, {11, 13}, {10, 13}, {5, 8},
                                                           {1, 21},  {0, 8},   {8, 8}};
    for (const auto& [hits, n] : shares) {
        const Interval share = wilson(hits, n);
        expectAll({share.low, share.high}, "wilson." + std::to_string(hits) + "_" + std::to_string(n));
    }
}

TEST(AgainstR, Reliability) {
    expectAll({cronbachsAlpha(tableOf(rValues("alpha.values"), 6))}, "alpha.alpha");
    expectAll({icc21(tableOf(rValues("icc.values"), 3))}, "icc.icc");
    const auto kappa = [](KappaWeights weights) {
        return cohensKappa(rValues("kappa.first"), rValues("kappa.second"), weights);
    };
    expectAll({kappa(KappaWeights::kNone)}, "kappa.plain");
    expectAll({kappa(KappaWeights::kQuadratic)}, "kappa.quadratic");
}

}  // namespace
}  // namespace bonemill::study
