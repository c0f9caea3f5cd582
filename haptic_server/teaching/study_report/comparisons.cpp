#include "haptic_server/teaching/study_report/comparisons.h"

#include <cmath>

#include "haptic_server/teaching/study_statistics/effect_sizes.h"
#include "haptic_server/teaching/study_statistics/planning.h"

namespace bonemill::study {
namespace {

GroupComparison compared(const StudyData& data, const Measure& measure, const std::string& first,
                         const std::string& second) {
    const std::vector<double> a = ofGroup(data, measure, first), b = ofGroup(data, measure, second);
    const uint64_t seed = data.protocol().seed;
    GroupComparison comparison;
    comparison.measure = &measure;
    comparison.first = first;
    comparison.second = second;
    comparison.of_first = summarise(a);
    comparison.of_second = summarise(b);
    if (a.empty() || b.empty()) return comparison;
    comparison.welch = welch(a, b);
    comparison.rank = mannWhitney(a, b);
    comparison.g = hedgesG(a, b);
    comparison.auc = aucOf(a, b);
    comparison.delta = cliffsDelta(comparison.auc);
    comparison.of_g = bootstrapInterval(a, b, hedgesG, seed);
    comparison.of_auc = bootstrapInterval(a, b, aucOf, seed);
    // Delta is a straight line of AUC, and so is its interval.
    comparison.of_delta = {cliffsDelta(comparison.of_auc.low), cliffsDelta(comparison.of_auc.high)};
    return comparison;
}

ConditionComparison comparedWithin(const Measure& measure, const std::string& first,
                                   const std::string& second) {
    const std::map<size_t, double> under_first = measure.byPerson(first),
                                   under_second = measure.byPerson(second);
    std::vector<double> a, b;
    for (const auto& [person, value] : under_first)
        if (const auto other = under_second.find(person); other != under_second.end()) {
            a.push_back(value);
            b.push_back(other->second);
        }
    ConditionComparison comparison;
    comparison.measure = &measure;
    comparison.first = first;
    comparison.second = second;
    comparison.of_first = summarise(a);
    comparison.of_second = summarise(b);
    if (a.size() < 2) return comparison;
    std::vector<double> differences = differencesOf(a, b);
    for (double& difference : differences) difference = withoutRounding(difference);
    comparison.paired = pairedT(a, b);
    comparison.pratt = prattSignedRank(differences);
    const double sd = std::sqrt(varianceOf(differences));
    comparison.d = sd > 0 ? meanOf(differences) / sd : kNotKnown;
    return comparison;
}

// A statement of SUS means nothing by itself (Brooke 1996).
bool isCompared(const Measure& measure) {
    return measure.is_score || measure.form->scoring != Scoring::kSus;
}

bool areOfOneFamily(const Measure& a, const Measure& b) {
    return a.form == b.form && a.is_score == b.is_score;
}

// Adjusts one kind of P within each family.
template <class Comparison, class P>
void adjust(std::vector<Comparison>& all, const P& p, double Comparison::*adjusted) {
    for (const Comparison& leader : all) {
        std::vector<Comparison*> family;
        std::vector<double> values;
        for (Comparison& other : all)
            if (areOfOneFamily(*leader.measure, *other.measure)) {
                family.push_back(&other);
                values.push_back(p(other));
            }
        if (family.front() != &leader) continue;
        const std::vector<double> holms = holm(values);
        for (size_t i = 0; i < family.size(); ++i) family[i]->*adjusted = holms[i];
    }
}

}  // namespace

std::vector<GroupComparison> compareGroups(const StudyData& data, const std::vector<Measure>& measures) {
    const std::vector<Group>& groups = data.protocol().groups;
    std::vector<GroupComparison> all;
    for (const Measure& measure : measures)
        for (size_t i = 0; i < groups.size() && isCompared(measure); ++i)
            for (size_t j = i + 1; j < groups.size(); ++j)
                all.push_back(compared(data, measure, groups[i].id, groups[j].id));
    adjust(
        all, [](const GroupComparison& one) { return one.welch.p; }, &GroupComparison::holm_welch);
    adjust(
        all, [](const GroupComparison& one) { return one.rank.p; }, &GroupComparison::holm_rank);
    return all;
}

std::vector<ConditionComparison> compareConditions(const StudyData& data,
                                                   const std::vector<Measure>& measures) {
    const std::vector<Condition>& conditions = data.protocol().conditions;
    std::vector<ConditionComparison> all;
    for (const Measure& measure : measures) {
        if (!isCompared(measure) || !measure.hasConditions()) continue;
        for (size_t i = 0; i < conditions.size(); ++i)
            for (size_t j = i + 1; j < conditions.size(); ++j)
                all.push_back(comparedWithin(measure, conditions[i].id, conditions[j].id));
    }
    adjust(
        all, [](const ConditionComparison& one) { return one.paired.p; }, &ConditionComparison::holm_paired);
    adjust(
        all, [](const ConditionComparison& one) { return one.pratt.p; }, &ConditionComparison::holm_pratt);
    return all;
}

}  // namespace bonemill::study
