#include "haptic_server/teaching/study_statistics/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "haptic_server/teaching/study_statistics/distributions.h"

namespace bonemill::study {
namespace {

// Ways to reach each sum; as doubles, for they outgrow 64 bits. All are positive, so that nothing cancels.
using Ways = std::vector<double>;

// Average ranks are whole or half: twice as large they are whole.
std::vector<size_t> doubled(const std::vector<double>& ranks) {
    std::vector<size_t> whole(ranks.size());
    std::transform(ranks.begin(), ranks.end(), whole.begin(),
                   [](double rank) { return size_t(std::lround(2 * rank)); });
    return whole;
}

// How often `take` of the ranks have each sum.
Ways sumsOfSubsets(const std::vector<size_t>& ranks, size_t take) {
    const size_t most = std::accumulate(ranks.begin(), ranks.end(), size_t(0));
    std::vector<Ways> ways(take + 1, Ways(most + 1, 0.0));
    ways[0][0] = 1;
    size_t seen = 0, reach = 0;
    for (const size_t rank : ranks) {
        reach += rank;
        ++seen;
        for (size_t k = std::min(seen, take); k > 0; --k)
            for (size_t sum = reach; sum >= rank; --sum) ways[k][sum] += ways[k - 1][sum - rank];
    }
    return ways[take];
}

// How often the ranks with a random sign have each sum of the positive ones.
Ways sumsOfSigns(const std::vector<size_t>& ranks) {
    Ways ways(std::accumulate(ranks.begin(), ranks.end(), size_t(0)) + 1, 0.0);
    ways[0] = 1;
    size_t reach = 0;
    for (const size_t rank : ranks) {
        reach += rank;
        for (size_t sum = reach; sum >= rank; --sum) ways[sum] += ways[sum - rank];
    }
    return ways;
}

// `expected` is that of the doubled sum, times two so that it is whole.
RankTest exactTest(const Ways& ways, size_t sum, int64_t expected_twice, double statistic) {
    double all = 0, less = 0, greater = 0, far = 0;
    const int64_t distance = std::abs(2 * int64_t(sum) - expected_twice);
    for (size_t i = 0; i < ways.size(); ++i) {
        all += ways[i];
        if (i <= sum) less += ways[i];
        if (i >= sum) greater += ways[i];
        if (std::abs(2 * int64_t(i) - expected_twice) >= distance) far += ways[i];
    }
    return {statistic, far / all, less / all, greater / all, true};
}

RankTest normalTest(double statistic, double expected, double variance) {
    if (!(variance > 0)) return {.statistic = statistic};
    const double z = (statistic - expected) / std::sqrt(variance);
    return {statistic, 2 * normalCdf(-std::abs(z)), normalCdf(z), normalCdf(-z), false};
}

}  // namespace

std::vector<double> ranksOf(Sample values) {
    std::vector<size_t> order(values.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return values[i] < values[j]; });
    std::vector<double> ranks(values.size());
    for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (size_t i = begin; i < end; ++i) ranks[order[i]] = double(begin + end + 1) / 2;
    }
    return ranks;
}

RankTest mannWhitney(Sample a, Sample b) {
    const size_t m = a.size(), total = m + b.size();
    if (a.empty() || b.empty()) return {};
    std::vector<double> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const std::vector<double> ranks = ranksOf(all);
    const double rank_sum = std::accumulate(ranks.begin(), ranks.begin() + long(m), 0.0);
    const double u = rank_sum - double(m * (m + 1)) / 2;
    if (total <= kMaxExact) {
        const std::vector<size_t> whole = doubled(ranks);
        const size_t sum = std::accumulate(whole.begin(), whole.begin() + long(m), size_t(0));
        return exactTest(sumsOfSubsets(whole, m), sum, int64_t(2 * m * (total + 1)), u);
    }
    double squares = 0;
    const double middle = double(total + 1) / 2;
    for (const double rank : ranks) squares += (rank - middle) * (rank - middle);
    const double variance = double(m * b.size()) / double(total * (total - 1)) * squares;
    return normalTest(u, double(m * b.size()) / 2, variance);
}

RankTest prattSignedRank(Sample differences) {
    std::vector<double> sizes(differences.size());
    std::transform(differences.begin(), differences.end(), sizes.begin(),
                   [](double d) { return std::abs(d); });
    const std::vector<double> ranks = ranksOf(sizes);
    std::vector<double> kept;
    double positive = 0, all = 0, squares = 0;
    for (size_t i = 0; i < ranks.size(); ++i) {
        if (differences[i] == 0) continue;
        kept.push_back(ranks[i]);
        all += ranks[i];
        squares += ranks[i] * ranks[i];
        if (differences[i] > 0) positive += ranks[i];
    }
    if (kept.empty()) return {};
    if (kept.size() > kMaxExact) return normalTest(positive, all / 2, squares / 4);
    return exactTest(sumsOfSigns(doubled(kept)), size_t(std::lround(2 * positive)), std::lround(2 * all),
                     positive);
}

}  // namespace bonemill::study
