#include "haptic_server/lab/what_if/what_if_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "haptic_server/assessment/measures/moment_finder.h"
#include "haptic_server/teaching/attempt_report/charts.h"
#include "haptic_server/teaching/attempt_report/html_report.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

constexpr size_t kMarked = 1;  // moments on each time line: the one from which on it is otherwise

struct Row {
    std::string label, happened, otherwise, difference;
    bool is_first = false;  // of what people look at first
};

// Of two figures that were summed in another order.
constexpr double kRounding = 1e-9;

std::string differenceText(double happened, double otherwise, const std::string& unit) {
    const double difference = otherwise - happened;
    if (std::abs(difference) <= kRounding * std::abs(happened)) return "same";
    return (difference > 0 ? "+" : "−") + valueText(std::abs(difference), unit);
}

const GateResult* gateOf(const Assessment& assessment, const std::string& id) {
    const auto found = std::ranges::find(assessment.gates, id, &GateResult::id);
    return found == assessment.gates.end() ? nullptr : &*found;
}

std::string heldText(const GateResult* gate) {
    return !gate ? "" : gate->is_passed ? "held" : "broken";
}

void addScores(const Assessment& happened, const Assessment& otherwise, std::vector<Row>& rows) {
    if (happened.total && otherwise.total)
        rows.push_back({"Score of 100", roundedText(100 * happened.total->score),
                        roundedText(100 * otherwise.total->score),
                        differenceText(100 * happened.total->score, 100 * otherwise.total->score, ""), true});
    for (const GateResult& gate : happened.gates) {
        const GateResult* const other = gateOf(otherwise, gate.id);
        const bool is_same = other && other->is_passed == gate.is_passed;
        rows.push_back(
            {"Limit: " + gate.label, heldText(&gate), heldText(other), is_same ? "same" : "changed", true});
    }
}

// Figures of one course alone have a dash in the other.
void addFigures(const Assessment& happened, const Assessment& otherwise, std::vector<Row>& rows) {
    std::vector<std::string> first;
    for (const Figure* figure : firstFigures(happened)) first.push_back(figure->id);
    for (const SubScore& sub : happened.sub_scores) first.push_back(sub.figure.id);
    const auto isFirst = [&](const std::string& id) { return std::ranges::count(first, id) > 0; };
    for (const Figure& figure : happened.figures) {
        const Figure* const other = findFigure(otherwise.figures, figure.id, figure.version);
        rows.push_back({figure.label, valueText(figure.value, figure.unit),
                        other ? valueText(other->value, figure.unit) : "–",
                        other ? differenceText(figure.value, other->value, figure.unit) : "",
                        isFirst(figure.id)});
    }
    for (const Figure& figure : otherwise.figures)
        if (!findFigure(happened.figures, figure.id, figure.version))
            rows.push_back({figure.label, "–", valueText(figure.value, figure.unit), "", true});
}

std::vector<Row> rowsOf(const Course& happened, const Course& otherwise) {
    std::vector<Row> rows;
    addScores(happened.assessment, otherwise.assessment, rows);
    addFigures(happened.assessment, otherwise.assessment, rows);
    return rows;
}

std::string tableOf(const std::vector<Row>& rows, bool of_first) {
    std::string out =
        "<tr><th></th><th class='n'>as it happened</th><th class='n'>otherwise</th><th "
        "class='n'>difference</th></tr>";
    bool is_empty = true;
    for (const Row& row : rows) {
        if (row.is_first != of_first) continue;
        is_empty = false;
        out += element("tr", element("td", escaped(row.label)) +
                                 element("td", escaped(row.happened), "class='n'") +
                                 element("td", escaped(row.otherwise), "class='n'") +
                                 element("td", escaped(row.difference), "class='n'"));
    }
    return is_empty ? "" : element("table", out);
}

std::string courseOf(const std::string& title, const Course& course, double at_s) {
    const std::vector<Moment> from(kMarked, Moment{at_s, "", "", 0});
    const std::string line = timeLineSvg(course.assessment, from, course.begin_s);
    return line.empty() ? "" : element("section", element("h2", title) + line);
}

}  // namespace

std::string whatIfPage(const Course& happened, const Course& otherwise, const WhatIfWords& words) {
    const std::vector<Row> rows = rowsOf(happened, otherwise);
    const std::string who = words.trainee.empty() ? "a session" : escaped(words.trainee);
    std::string out = pageHead("What if? " + words.scene_title);
    out += element("header",
                   element("div", element("h1", "What if? " + escaped(words.scene_title)) +
                                      element("p", "From " + clockText(words.at_s - happened.begin_s) +
                                                       " on (1 in the time lines) of what " + who +
                                                       " did: " + element("b", escaped(words.change)))));
    out += element("section", tableOf(rows, true));
    out += courseOf("As it happened", happened, words.at_s) + courseOf("Otherwise", otherwise, words.at_s);
    if (const std::string others = tableOf(rows, false); !others.empty())
        out += element("section", element("details", element("summary", "All other figures") +
                                                         element("div", others, "class='figures'")));
    out += element("footer", escaped(words.proof) +
                                 " Nobody did the second: hand and decisions are those of "
                                 "the recording, which did not feel another force. " +
                                 "Both side by side: " + element("code", escaped(words.replay)) +
                                 ". What each figure is: docs/reference/assessment.md.");
    return out + "</body></html>\n";
}

std::string whatIfText(const Course& happened, const Course& otherwise) {
    std::string out;
    char line[256];
    const auto add = [&](const Row& row) {
        std::snprintf(line, sizeof line, "%-44.60s %14s %14s   %s\n", row.label.c_str(), row.happened.c_str(),
                      row.otherwise.c_str(), row.difference.c_str());
        out += line;
    };
    add({"", "happened", "otherwise", ""});
    for (const Row& row : rowsOf(happened, otherwise))
        if (row.is_first) add(row);
    return out;
}

}  // namespace bonemill
