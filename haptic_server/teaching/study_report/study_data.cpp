#include "haptic_server/teaching/study_report/study_data.h"

#include <algorithm>
#include <cmath>

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

}  // namespace bonemill::study
