#include "haptic_server/teaching/study_report/study_report_text.h"

#include <algorithm>
#include <cmath>

#include "common/text/csv_text.h"
#include "haptic_server/teaching/study_report/number_text.h"
#include "haptic_server/teaching/study_report/plan_text.h"
#include "haptic_server/teaching/study_report/study_tables.h"
#include "haptic_server/teaching/study_statistics/planning.h"

namespace bonemill::study {
namespace {

std::string rowText(const std::vector<std::string>& cells) {
    std::string row = "|";
    for (const std::string& cell : cells) row += " " + cell + " |";
    return row + "\n";
}

std::string tableHead(const std::vector<std::string>& cells) {
    return rowText(cells) + rowText(std::vector<std::string>(cells.size(), "---"));
}

std::string meanText(const Summary& summary) {
    return fixedText(summary.mean, 2) + " (" + fixedText(summary.sd, 2) + ")";
}

std::string nameOf(const Measure& measure) {
    return measure.is_score ? cellText(measure.title) : measure.id + ": " + cellText(measure.title);
}

template <class Comparison>
std::vector<Comparison> ofForm(const std::vector<Comparison>& all, const Form& form) {
    std::vector<Comparison> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some), [&](const Comparison& one) {
        return one.measure->form == &form && (one.of_first.n > 0 || one.of_second.n > 0);
    });
    return some;
}

size_t testsIn(const std::vector<GroupComparison>& comparisons, bool is_score) {
    return size_t(std::count_if(comparisons.begin(), comparisons.end(), [&](const GroupComparison& one) {
        return one.measure->is_score == is_score && !std::isnan(one.rank.p);
    }));
}

std::string itemsText(const StudyData& data, const std::vector<Measure>& measures, const Form& form) {
    const double threshold = data.protocol().threshold;
    std::string text = tableHead({"question", "people", "mean (SD)", "median", "least to most",
                                  "share of " + numberText(threshold) + " or more (95 %, Wilson)"});
    for (const Measure& measure : measures) {
        if (measure.form != &form) continue;
        std::vector<double> values;
        for (const auto& [person, mean] : measure.byPerson()) values.push_back(mean);
        const Summary summary = summarise(values);
        const size_t hits = hitsOf(values, threshold);
        const Interval share = wilson(hits, values.size());
        text += rowText(
            {nameOf(measure), std::to_string(summary.n), meanText(summary), fixedText(summary.median, 2),
             fixedText(summary.least, 1) + " to " + fixedText(summary.most, 1),
             measure.has_share ? percentText(double(hits) / double(values.size())) + " (" +
                                     percentText(share.low) + " to " + percentText(share.high) + ")"
                               : "–"});
    }
    return text;
}

std::string groupsText(const std::vector<GroupComparison>& comparisons) {
    std::string text =
        tableHead({"question", "groups", "mean (SD)", "mean (SD)", "difference (95 %)", "Welch P", "Holm",
                   "Mann-Whitney P", "Holm", "Hedges g (95 %)", "Cliff's delta (95 %)", "AUC (95 %)"});
    for (const GroupComparison& one : comparisons)
        text += rowText(
            {nameOf(*one.measure),
             one.first + " " + std::to_string(one.of_first.n) + ", " + one.second + " " +
                 std::to_string(one.of_second.n),
             meanText(one.of_first), meanText(one.of_second),
             fixedText(one.welch.difference, 2) + " (" + intervalText(one.welch.interval, 2) + ")",
             pText(one.welch.p), pText(one.holm_welch),
             pText(one.rank.p) + (one.rank.is_exact || std::isnan(one.rank.p) ? "" : " (approximate)"),
             pText(one.holm_rank), fixedText(one.g, 2) + " (" + intervalText(one.of_g, 2) + ")",
             fixedText(one.delta, 2) + " (" + intervalText(one.of_delta, 2) + ")",
             fixedText(one.auc, 2) + " (" + intervalText(one.of_auc, 2) + ")"});
    return text;
}

std::string conditionsText(const std::vector<ConditionComparison>& comparisons) {
    std::string text = tableHead({"question", "conditions", "people with both", "mean (SD)", "mean (SD)",
                                  "difference (95 %)", "paired t, P", "Holm", "Wilcoxon-Pratt P", "Holm",
                                  "d of the differences"});
    for (const ConditionComparison& one : comparisons)
        text +=
            rowText({nameOf(*one.measure), one.first + ", " + one.second, std::to_string(one.of_first.n),
                     meanText(one.of_first), meanText(one.of_second),
                     fixedText(one.paired.difference, 2) + " (" + intervalText(one.paired.interval, 2) + ")",
                     pText(one.paired.p), pText(one.holm_paired), pText(one.pratt.p), pText(one.holm_pratt),
                     fixedText(one.d, 2)});
    return text;
}

std::string alphasText(const StudyData& data, const std::vector<Measure>& measures, const Form& form) {
    std::string text;
    for (const Alpha& alpha : alphasOf(data, measures))
        if (alpha.form == &form)
            text += "- " + alpha.block + ": " + fixedText(alpha.alpha, 2) + " (" +
                    std::to_string(alpha.items) + " items, " + std::to_string(alpha.people) +
                    " people with all of them)\n";
    return text.empty() ? "" : "\nCronbach's alpha of each block:\n\n" + text;
}

// What stands after Holm's adjustment, and what only seems to.
std::string verdictText(const std::vector<GroupComparison>& comparisons, double alpha) {
    std::string stands, seems;
    for (const GroupComparison& one : comparisons) {
        const std::string name = one.measure->id + " (" + one.first + ", " + one.second + ")";
        if (one.holm_rank <= alpha)
            stands += (stands.empty() ? "" : ", ") + name;
        else if (one.rank.p <= alpha || one.welch.p <= alpha)
            seems += (seems.empty() ? "" : ", ") + name;
    }
    return "\nDifferences between groups that stand after Holm's adjustment (Mann-Whitney): " +
           (stands.empty() ? "none" : stands) + ".\n" +
           (seems.empty() ? ""
                          : "Below " + pText(alpha) +
                                " by themselves, in one test at least, and not after it: " + seems +
                                ". Take these as questions for the next study.\n");
}

std::string canSeeText(const StudyData& data, const std::vector<GroupComparison>& of_form) {
    const std::vector<Group>& groups = data.protocol().groups;
    std::string text;
    for (size_t i = 0; i < groups.size(); ++i)
        for (size_t j = i + 1; j < groups.size(); ++j) {
            Plan plan{0,
                      0,
                      std::max<size_t>(1, testsIn(of_form, false)),
                      data.protocol().alpha,
                      data.protocol().power,
                      {}};
            for (const GroupComparison& one : of_form)
                if (one.first == groups[i].id && one.second == groups[j].id) {
                    plan.first = std::max(plan.first, one.of_first.n);
                    plan.second = std::max(plan.second, one.of_second.n);
                }
            text += "\n" + groups[i].title + " and " + groups[j].title + ":\n\n" + planText(plan);
        }
    return text;
}

std::string formText(const StudyData& data, const std::vector<Measure>& measures, const Form& form,
                     const std::vector<GroupComparison>& groups,
                     const std::vector<ConditionComparison>& conditions) {
    std::string text = "\n## " + cellText(form.title) + "\n\n`" + form.id + "`, version " +
                       std::to_string(form.version) + ". " + cellText(form.source) + "\n\n" +
                       itemsText(data, measures, form) + alphasText(data, measures, form);
    if (!groups.empty())
        text += "\n### Between groups\n\n" + groupsText(groups) + verdictText(groups, data.protocol().alpha) +
                "\nWhat these tests can see:\n" + canSeeText(data, groups);
    if (!conditions.empty()) text += "\n### Between conditions\n\n" + conditionsText(conditions);
    return text;
}

constexpr char kMethods[] = R"(
## How it was computed

Each person counts once: where somebody answered a question in several sessions, the mean of them. SUS is compared by
its score only. Welch's test has Satterthwaite's degrees of freedom. Mann-Whitney and Wilcoxon-Pratt are exact up to
100 people, ties included, and to both sides: the chance to be at least as far from the expected value. For single
questions with few steps and small unequal groups Mann-Whitney is the one to go by; Welch stands beside it because
others report it. Holm's adjustment counts all questions of a form (and, apart, all its scores) over all pairs. Hedges
g is above zero where the first group answers higher; AUC is the chance that one of the first group does; Cliff's
delta is 2 AUC - 1. Their intervals are bias-corrected accelerated bootstraps of 2000 draws within the groups, seeded
by the protocol; a dash says that the data do not determine one. Shares have Wilson's intervals. A dash elsewhere: not
defined for these data (one person, no spread).

What no table here can say: experts and novices who answer alike, or apart, is weak evidence of validity by itself; a
mean above a threshold says that people were content, not that they learn. `analysis.R` goes on in R with
mixed models for repeated tasks; `checklist.md` is what a report owes its readers.
)";

}  // namespace

std::string cellText(const std::string& text) {
    std::string cell;
    for (const char c : text) {
        if (std::string_view("\\`*_[]<>|#").find(c) != std::string_view::npos) cell += '\\';
        cell += c;
    }
    return cell;
}

std::string flowTable(const StudyData& data) {
    const Enrolled enrolled = data.folder->enrolled();
    std::string text =
        tableHead({"group", "wanted", "enrolled", "in the data", "left early", "answered everything"});
    for (const Group& group : data.protocol().groups) {
        size_t here = 0, left = 0, whole = 0;
        for (size_t i = 0; i < data.people.size(); ++i) {
            const Participant& person = data.people[i];
            if (person.group != group.id) continue;
            ++here;
            left += person.has_withdrawn;
            bool is_whole = true;
            for (const Session& session : person.sessions)
                for (const std::string& id : data.folder->formsOf(session))
                    is_whole &=
                        std::any_of(data.filled.begin(), data.filled.end(), [&](const FilledForm& filled) {
                            return filled.session.uuid == session.uuid && filled.form->id == id &&
                                   filled.answers.isFinished(*filled.form);
                        });
            whole += is_whole;
        }
        const auto places = enrolled.places.find(group.id);
        text += rowText({cellText(group.title), group.wanted ? std::to_string(group.wanted) : "–",
                         std::to_string(places == enrolled.places.end() ? 0 : places->second),
                         std::to_string(here), std::to_string(left), std::to_string(whole)});
    }
    return text + "\nRemoved at their own wish, with all their data: " + std::to_string(enrolled.removed) +
           ".\n";
}

std::string reportText(const StudyData& data, const std::vector<Measure>& measures,
                       const std::vector<GroupComparison>& groups,
                       const std::vector<ConditionComparison>& conditions) {
    const Protocol& protocol = data.protocol();
    std::string text = "# " + cellText(protocol.title) + "\n\nStudy `" + protocol.id +
                       "`, protocol SHA-256 `" + data.folder->protocolDigest() + "`, seed " +
                       std::to_string(protocol.seed) + ".\n\n" + flowTable(data);
    for (const std::string& id : protocol.formIds()) {
        const Form& form = data.folder->form(id);
        const bool has_answers = std::any_of(measures.begin(), measures.end(),
                                             [&](const Measure& measure) { return measure.form == &form; });
        if (has_answers)
            text += formText(data, measures, form, ofForm(groups, form), ofForm(conditions, form));
    }
    if (measures.empty()) text += "\nThere are no ratings yet.\n";
    return text + kMethods;
}

}  // namespace bonemill::study
