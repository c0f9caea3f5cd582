#include "haptic_server/teaching/study_report/study_tables.h"

#include <algorithm>

#include "common/text/csv_text.h"
#include "haptic_server/teaching/study_statistics/planning.h"

namespace bonemill::study {
namespace {

CsvLine& operator<<(CsvLine& line, const Interval& interval) {
    return line << interval.low << interval.high;
}

CsvLine lineOf(const StudyData& data, const FilledForm& filled) {
    const Session& session = filled.session;
    const Participant& person = data.people[filled.person];
    CsvLine line;
    line << session.uuid << person.pseudonym << person.group << session.period << session.condition
         << session.task << session.attempt << filled.form->id;
    return line;
}

constexpr char kSessionColumns[] = "session,pseudonym,group,period,condition,task,attempt,form,";

TableFile answersTable(const StudyData& data) {
    std::string text = std::string(kSessionColumns) + "form_version,block,item,rating,value,words,left_out\n";
    for (const FilledForm& filled : data.filled)
        for (const Block& block : filled.form->blocks)
            for (const Item& item : block.items) {
                if (!filled.answers.isAnswered(item.id)) continue;
                CsvLine line = lineOf(data, filled);
                line << filled.form->version << block.id << item.id << size_t(item.is_rating);
                const auto found = filled.answers.values.find(item.id);
                const bool is_given = found != filled.answers.values.end();
                if (!is_given)
                    line.nothing().nothing();
                else if (const double* value = std::get_if<double>(&found->second))
                    (line << *value).nothing();
                else
                    line.nothing() << std::get<std::string>(found->second);
                line << size_t(!is_given);
                text += line.end();
            }
    return {"answers.csv", text};
}

TableFile scoresTable(const StudyData& data) {
    std::string text = std::string(kSessionColumns) + "score,value\n";
    for (const FilledForm& filled : data.filled)
        for (const Score& score : scoresOf(*filled.form, filled.answers.values))
            text += (lineOf(data, filled) << score.id << score.value).end();
    return {"scores.csv", text};
}

TableFile sessionsTable(const StudyData& data) {
    std::string text =
        "session,pseudonym,group,withdrawn,period,condition,task,attempt,scene,scene_sha256,programs,"
        "recording";
    for (const char* const figure : kRunFigures) text += std::string(",") + figure;
    text += "\n";
    for (const Participant& person : data.people)
        for (const Session& session : person.sessions) {
            const auto found = data.runs.find(session.uuid);
            const RunRecord run = found == data.runs.end() ? RunRecord() : found->second;
            CsvLine line;
            line << session.uuid << person.pseudonym << person.group << size_t(person.has_withdrawn)
                 << session.period << session.condition << session.task << session.attempt << run.scene
                 << run.scene_sha256 << run.programs << run.recording;
            for (const char* const figure : kRunFigures)
                line << (run.figures.contains(figure) ? run.figures.at(figure) : kNotKnown);
            text += line.end();
        }
    return {"sessions.csv", text};
}

CsvLine& operator<<(CsvLine& line, const Summary& summary) {
    return line << summary.n << summary.mean << summary.sd << summary.median << summary.least << summary.most;
}

TableFile itemsTable(const StudyData& data, const std::vector<Measure>& measures) {
    std::string text =
        "form,block,item,is_score,group,n,mean,sd,median,least,most,at_least_threshold,share,share_low,share_"
        "high\n";
    for (const Measure& measure : measures)
        for (size_t i = 0; i <= data.protocol().groups.size(); ++i) {
            std::vector<double> values;
            const std::string group = i == 0 ? "" : data.protocol().groups[i - 1].id;
            if (i == 0)
                for (const auto& [person, mean] : measure.byPerson()) values.push_back(mean);
            else
                values = ofGroup(data, measure, group);
            CsvLine line;
            line << measure.form->id << measure.block << measure.id << size_t(measure.is_score)
                 << (i == 0 ? "all" : group);
            line << summarise(values);
            const size_t hits = hitsOf(values, data.protocol().threshold);
            const bool has_share = measure.has_share && !values.empty();
            if (has_share)
                line << hits << double(hits) / double(values.size()) << wilson(hits, values.size());
            else
                line.nothing().nothing() << Interval();
            text += line.end();
        }
    return {"items.csv", text};
}

TableFile groupsTable(const std::vector<GroupComparison>& comparisons) {
    std::string text =
        "form,item,first,second,n1,mean1,sd1,median1,least1,most1,n2,mean2,sd2,median2,least2,most2,"
        "difference,"
        "difference_low,difference_high,welch_t,welch_df,welch_p,welch_holm_p,u,mann_whitney_p,is_exact,"
        "mann_whitney_holm_p,hedges_g,g_low,g_high,cliffs_delta,delta_low,delta_high,auc,auc_low,auc_high\n";
    for (const GroupComparison& one : comparisons) {
        CsvLine line;
        line << one.measure->form->id << one.measure->id << one.first << one.second;
        line << one.of_first;
        line << one.of_second;
        line << one.welch.difference << one.welch.interval << one.welch.t << one.welch.df << one.welch.p
             << one.holm_welch << one.rank.statistic << one.rank.p << size_t(one.rank.is_exact)
             << one.holm_rank << one.g << one.of_g << one.delta << one.of_delta << one.auc << one.of_auc;
        text += line.end();
    }
    return {"group_comparisons.csv", text};
}

TableFile conditionsTable(const std::vector<ConditionComparison>& comparisons) {
    std::string text =
        "form,item,first,second,n,mean1,sd1,mean2,sd2,difference,difference_low,difference_high,paired_t,df,"
        "paired_p,"
        "paired_holm_p,pratt_w,pratt_p,is_exact,pratt_holm_p,d_of_differences\n";
    for (const ConditionComparison& one : comparisons)
        text += (CsvLine() << one.measure->form->id << one.measure->id << one.first << one.second
                           << one.of_first.n << one.of_first.mean << one.of_first.sd << one.of_second.mean
                           << one.of_second.sd << one.paired.difference << one.paired.interval << one.paired.t
                           << one.paired.df << one.paired.p << one.holm_paired << one.pratt.statistic
                           << one.pratt.p << size_t(one.pratt.is_exact) << one.holm_pratt << one.d)
                    .end();
    return {"condition_comparisons.csv", text};
}

TableFile alphaTable(const StudyData& data, const std::vector<Measure>& measures) {
    std::string text = "form,block,people,items,alpha\n";
    for (const Alpha& alpha : alphasOf(data, measures))
        text +=
            (CsvLine() << alpha.form->id << alpha.block << alpha.people << alpha.items << alpha.alpha).end();
    return {"alpha.csv", text};
}

}  // namespace

size_t hitsOf(const std::vector<double>& values, double threshold) {
    return size_t(
        std::count_if(values.begin(), values.end(), [&](double value) { return value >= threshold; }));
}

std::vector<TableFile> tablesOf(const StudyData& data, const std::vector<Measure>& measures,
                                const std::vector<GroupComparison>& groups,
                                const std::vector<ConditionComparison>& conditions) {
    return {answersTable(data),         scoresTable(data),   sessionsTable(data),
            itemsTable(data, measures), groupsTable(groups), conditionsTable(conditions),
            alphaTable(data, measures)};
}

}  // namespace bonemill::study
