#include "haptic_server/teaching/study_report/study_data.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/teaching/study_statistics/effect_sizes.h"
#include "haptic_server/teaching/study_statistics/planning.h"
#include "haptic_server/teaching/study_statistics/reliability.h"

namespace bonemill::study {
namespace {

Measure::Value valueOf(const FilledForm& filled, double value) {
    return {filled.person, filled.session.condition, value};
}

void addItems(const StudyData& data, const Form& form, std::vector<Measure>& measures) {
    for (const Block& block : form.blocks)
        for (const Item& item : block.items) {
            if (!item.is_rating) continue;
            const bool has_share = !item.options.empty() && form.scoring == Scoring::kNone;
            Measure measure{&form, block.id, item.id, item.text, false, has_share, {}};
            for (const FilledForm& filled : data.filled) {
                const auto found = filled.answers.values.find(item.id);
                if (filled.form == &form && found != filled.answers.values.end())
                    measure.values.push_back(valueOf(filled, std::get<double>(found->second)));
            }
            if (!measure.values.empty()) measures.push_back(std::move(measure));
        }
}

void addScores(const StudyData& data, const Form& form, std::vector<Measure>& measures) {
    std::map<std::string, Measure> scores;
    for (const FilledForm& filled : data.filled) {
        if (filled.form != &form) continue;
        for (const Score& score : scoresOf(form, filled.answers.values)) {
            Measure& measure = scores[score.id];
            measure.form = &form;
            measure.id = score.id;
            measure.title = score.title;
            measure.is_score = true;
            measure.values.push_back(valueOf(filled, score.value));
        }
    }
    for (auto& [id, measure] : scores) measures.push_back(std::move(measure));
}

// An item's mean answers.
struct Column {
    std::map<size_t, double> by_person;
    bool is_turned = false;  // a statement of SUS against the system
};

// The even ones of the form, whether or not all others were answered.
bool isTurned(const Measure& measure) {
    const std::vector<const Item*> items = measure.form->items();
    const auto at =
        std::find_if(items.begin(), items.end(), [&](const Item* item) { return item->id == measure.id; });
    return measure.form->scoring == Scoring::kSus && (at - items.begin()) % 2 == 1;
}

// A person's row of a block; empty when one item has no answer.
std::vector<double> rowOf(const std::vector<Column>& columns, size_t person) {
    std::vector<double> row;
    for (const Column& column : columns) {
        const auto found = column.by_person.find(person);
        if (found == column.by_person.end()) return {};
        row.push_back(column.is_turned ? 6 - found->second : found->second);
    }
    return row;
}

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

double withoutRounding(double value) {
    constexpr double kStep = 1e9;
    return std::round(value * kStep) / kStep;
}

StudyData readStudy(const StudyFolder& folder) {
    StudyData data{&folder, {}, {}, {}};
    for (const std::string& pseudonym : folder.pseudonyms()) {
        const Participant person = folder.participant(pseudonym);
        for (const Session& session : person.sessions) {
            for (const std::string& id : folder.formsOf(session)) {
                Answers answers = folder.answers(person, session.uuid, id);
                if (!answers.values.empty() || !answers.left_out.empty())
                    data.filled.push_back(
                        {data.people.size(), session, &folder.form(id), std::move(answers)});
            }
            if (const auto run = folder.run(person, session.uuid)) data.runs.emplace(session.uuid, *run);
        }
        data.people.push_back(person);
    }
    return data;
}

bool Measure::hasConditions() const {
    return std::any_of(values.begin(), values.end(),
                       [](const Value& value) { return !value.condition.empty(); });
}

std::map<size_t, double> Measure::byPerson(const std::string& condition) const {
    const bool has_conditions = hasConditions();
    const auto isWanted = [&](const Value& value) {
        return condition.empty() ? value.condition.empty() != has_conditions : value.condition == condition;
    };
    std::map<size_t, std::vector<double>> all;
    for (const Value& value : values)
        if (isWanted(value)) all[value.person].push_back(value.value);
    std::map<size_t, double> means;
    for (const auto& [person, of_person] : all) means[person] = withoutRounding(meanOf(of_person));
    return means;
}

std::vector<Measure> measuresOf(const StudyData& data) {
    std::vector<Measure> measures;
    for (const std::string& id : data.protocol().formIds()) {
        addItems(data, data.folder->form(id), measures);
        addScores(data, data.folder->form(id), measures);
    }
    return measures;
}

std::vector<double> ofGroup(const StudyData& data, const Measure& measure, const std::string& group) {
    std::vector<double> values;
    for (const auto& [person, mean] : measure.byPerson())
        if (data.people[person].group == group) values.push_back(mean);
    return values;
}

std::vector<Alpha> alphasOf(const StudyData& data, const std::vector<Measure>& measures) {
    std::vector<Alpha> alphas;
    for (size_t begin = 0, end = 0; begin < measures.size(); begin = end) {
        const Measure& first = measures[begin];
        std::vector<Column> columns;
        while (end < measures.size() && measures[end].form == first.form &&
               measures[end].block == first.block) {
            columns.push_back({measures[end].byPerson(), isTurned(measures[end])});
            ++end;
        }
        if (first.is_score || columns.size() < 2) continue;
        Table table;
        for (size_t person = 0; person < data.people.size(); ++person)
            if (auto row = rowOf(columns, person); !row.empty()) table.push_back(std::move(row));
        alphas.push_back({first.form, first.block, table.size(), columns.size(), cronbachsAlpha(table)});
    }
    return alphas;
}

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
