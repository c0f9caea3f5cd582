#include "haptic_server/teaching/attempt_report/class_page.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "haptic_server/teaching/attempt_report/charts.h"
#include "haptic_server/teaching/attempt_report/html_report.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

constexpr size_t kMostFailed = 8;
constexpr size_t kMeanOf = 3;  // attempts

using Attempts = std::vector<const AttemptResult*>;

// A scene whose text has changed is another one, and so are other weights: their attempts are not compared.
struct SceneAttempts {
    std::string title;
    Attempts all;
    std::map<std::string, Attempts> by_trainee;
};

std::vector<SceneAttempts> byScene(const std::vector<AttemptResult>& results) {
    std::vector<SceneAttempts> scenes;
    std::map<std::string, size_t> places;
    for (const AttemptResult& result : results) {
        const std::optional<Total>& total = result.assessment.total;
        const std::string kind = result.scene_hash + (total ? total->weights_hash : "");
        const auto [place, is_new] = places.try_emplace(kind, scenes.size());
        if (is_new) scenes.push_back({result.scene_title, {}, {}});
        SceneAttempts& scene = scenes[place->second];
        scene.all.push_back(&result);
        scene.by_trainee[result.pseudonym].push_back(&result);
    }
    return scenes;
}

bool haveTotals(const Attempts& attempts) {
    return std::ranges::all_of(attempts,
                               [](const AttemptResult* a) { return a->assessment.total.has_value(); });
}

bool haveGates(const Attempts& attempts) {
    return std::ranges::any_of(attempts, [](const AttemptResult* a) { return !a->assessment.gates.empty(); });
}

// Scores where there are some, else the time that it took.
std::vector<double> valuesOf(const Attempts& attempts, bool are_totals) {
    std::vector<double> values;
    for (const AttemptResult* attempt : attempts)
        values.push_back(are_totals ? 100 * attempt->assessment.total->score : attempt->duration_s);
    return values;
}

double meanOfLast(const std::vector<double>& values) {
    const size_t count = std::min(values.size(), kMeanOf);
    double sum = 0;
    for (size_t n = values.size() - count; n < values.size(); ++n) sum += values[n];
    return sum / double(count);
}

std::string failedMost(const Attempts& attempts) {
    std::map<std::pair<std::string, std::string>, size_t> failures;  // by figure and label
    for (const AttemptResult* attempt : attempts)
        for (const GateResult& gate : attempt->assessment.gates)
            if (!gate.is_passed) ++failures[{gate.figure_id, gate.label}];
    std::vector<std::pair<std::string, size_t>> most;
    for (const auto& [gate, count] : failures) most.emplace_back(gate.second, count);
    std::ranges::stable_sort(most, std::ranges::greater{}, &std::pair<std::string, size_t>::second);
    if (most.size() > kMostFailed) most.resize(kMostFailed);
    std::string rows;
    for (const auto& [label, count] : most)
        rows += element(
            "tr",
            element("td", escaped(label)) +
                element("td", scoreBarSvg(double(count) / double(attempts.size())), "class='score'") +
                element("td", std::to_string(count) + " of " + std::to_string(attempts.size()), "class='n'"));
    if (rows.empty()) rows = element("tr", element("td", "Nothing: all gates held in all attempts."));
    return element("div", element("h2", "Failed most") + element("table", rows, "class='scores'"));
}

std::string traineeRow(const std::string& name, const Attempts& attempts, bool are_totals,
                       const std::string& reports) {
    const std::vector<double> values = valuesOf(attempts, are_totals);
    const std::string unit = are_totals ? "" : "s";
    const auto passed = std::ranges::count_if(attempts, [](const AttemptResult* a) {
        return !a->assessment.gates.empty() && a->assessment.hasPassed();
    });
    std::string links;
    for (size_t n = 0; n < attempts.size(); ++n)
        links += element("a", std::to_string(n + 1),
                         "href='" + escaped(reports + "/" + fileStemOf(*attempts[n])) + ".html'") +
                 " ";
    const double best = are_totals ? std::ranges::max(values) : std::ranges::min(values);
    return element("tr", element("td", element("b", escaped(name))) +
                             element("td", std::to_string(attempts.size()), "class='n'") +
                             element("td", haveGates(attempts) ? std::to_string(passed) : "–", "class='n'") +
                             element("td", valueText(best, unit), "class='n'") +
                             element("td", valueText(meanOfLast(values), unit), "class='n'") +
                             element("td", links));
}

std::string traineesOf(const SceneAttempts& scene, bool are_totals, const std::string& reports) {
    const std::string what = are_totals ? "score" : "time";
    std::string rows =
        element("tr", "<th></th><th class='n'>attempts</th><th class='n'>passed</th><th class='n'>best " +
                          what + "</th><th class='n'>mean of the last three</th><th>reports</th>");
    for (const auto& [name, attempts] : scene.by_trainee)
        rows += traineeRow(name, attempts, are_totals, reports);
    return element("section", element("h2", "Trainees") + element("table", rows));
}

std::string curvesOf(const SceneAttempts& scene, bool are_totals) {
    std::string out;
    for (const auto& [name, attempts] : scene.by_trainee) {
        if (attempts.size() < 2) continue;
        const std::vector<double> values = valuesOf(attempts, are_totals);
        out += element("figure", attemptsSvg(values, are_totals ? "" : "s", fitLearningCurve(values)) +
                                     element("figcaption", escaped(name)));
    }
    if (out.empty()) return "";
    return element("section", element("h2", are_totals ? "Total score by attempt" : "Time by attempt") +
                                  element("div", out, "class='charts'"));
}

std::string sceneOf(const SceneAttempts& scene, const std::string& reports) {
    const bool are_totals = haveTotals(scene.all);
    const std::string unit = are_totals ? "" : "s";
    std::string words = std::to_string(scene.all.size()) + " attempts of " +
                        std::to_string(scene.by_trainee.size()) + " trainees";
    if (haveGates(scene.all)) {
        const auto passed = std::ranges::count_if(
            scene.all, [](const AttemptResult* a) { return a->assessment.hasPassed(); });
        words += ", " + std::to_string(passed) + " passed";
    }
    std::string top = element("div", element("h2", are_totals ? "All total scores" : "All times") +
                                         distributionSvg(valuesOf(scene.all, are_totals), unit));
    if (haveGates(scene.all)) top += failedMost(scene.all);
    return element("section", element("h1", escaped(scene.title)) + element("p", words) +
                                  element("div", top, "class='top'") +
                                  traineesOf(scene, are_totals, reports) + curvesOf(scene, are_totals));
}

}  // namespace

std::string classPage(const std::vector<AttemptResult>& results, const std::string& reports) {
    std::string out = pageHead("Class");
    for (const SceneAttempts& scene : byScene(results)) out += sceneOf(scene, reports);
    if (results.empty()) out += element("p", "There is no attempt yet.");
    if (results.size() >= kMostOnPage)
        out += element("p", "These are the newest " + std::to_string(kMostOnPage) + " attempts.");
    return out +
           element("footer",
                   "One attempt says little: judge by the mean of three or more. What each figure is, and "
                   "what it does not say: docs/reference/assessment.md. bonemill is no medical device.") +
           "</body></html>\n";
}

}  // namespace bonemill
