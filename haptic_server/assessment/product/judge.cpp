#include "haptic_server/assessment/product/judge.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bonemill {
namespace {

constexpr double kPercent = 100;

std::string numberOf(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string amountOf(double value, const std::string& unit) {
    return unit.empty() ? numberOf(value) : numberOf(value) + " " + std::string(writtenUnit(unit));
}

GateResult resultOf(const GateRule& rule, const Figures& figures) {
    GateResult gate{.id = rule.figure_id,
                    .label = rule.label,
                    .figure_id = rule.figure_id,
                    .limit = rule.limit,
                    .is_most = rule.is_most,
                    .is_passed = false,
                    .text = {}};
    const Figure* figure = findFigure(figures, rule.figure_id);
    if (!figure) {
        if (gate.label.empty()) gate.label = rule.figure_id;
        gate.text = gate.label + " was not measured";
        return gate;
    }
    if (gate.label.empty()) gate.label = figure->label;
    gate.is_passed = rule.is_most ? figure->value <= rule.limit : figure->value >= rule.limit;
    gate.text = figure->label + ": " + amountOf(figure->value, figure->unit) + "; " +
                (rule.is_most ? "at most " : "at least ") + amountOf(rule.limit, figure->unit) +
                (gate.is_passed ? " are asked for" : " were asked for");
    return gate;
}

double scoreOf(const ScoreRule& rule, double value) {
    return std::clamp((value - rule.worst) / (rule.best - rule.worst), 0.0, 1.0);
}

// The share of what was to be removed: where gates ask for it, the mean over them of how near they are.
double shareDone(const JudgedTask& task, const Figures& figures) {
    double sum = 0;
    int asked = 0;
    for (const GateRule& rule : task.gates) {
        if (rule.is_most || rule.limit <= 0 || rule.figure_id.find(".removed") == std::string::npos) continue;
        const Figure* figure = findFigure(figures, rule.figure_id);
        if (figure) sum += std::clamp(figure->value / rule.limit, 0.0, 1.0);
        ++asked;
    }
    if (asked > 0) return sum / asked;
    if (const Figure* target = findFigure(figures, "target.removed"))
        return std::clamp(target->value / kPercent, 0.0, 1.0);
    const Figure* removed = findFigure(figures, "product.removed_volume");
    return removed && removed->value > 0 ? 1 : 0;
}

double totalOf(double mean, double done, const std::vector<GateResult>& gates) {
    const auto passed = double(std::ranges::count(gates, true, &GateResult::is_passed));
    const double quality = mean * done;
    if (gates.empty()) return quality;
    if (passed == double(gates.size())) return kPassMark + (1 - kPassMark) * quality;
    const double held = passed / double(gates.size());
    return kPassMark * quality * held * held;
}

}  // namespace

Assessment judge(const JudgedTask& task, Figures figures) {
    Assessment assessment;
    for (const GateRule& rule : task.gates) assessment.gates.push_back(resultOf(rule, figures));
    double sum = 0, weights = 0;
    for (const ScoreRule& rule : task.scores) {
        weights += rule.weight;
        const Figure* figure = findFigure(figures, rule.figure_id);
        if (!figure) continue;
        SubScore score{.id = rule.figure_id,
                       .label = rule.label.empty() ? figure->label : rule.label,
                       .figure = *figure,
                       .worst = rule.worst,
                       .best = rule.best,
                       .score = scoreOf(rule, figure->value),
                       .weight = rule.weight};
        sum += score.weight * score.score;
        assessment.sub_scores.push_back(std::move(score));
    }
    const double done = shareDone(task, figures);
    if (weights > 0)
        assessment.total = Total{.score = totalOf(sum / weights, done, assessment.gates),
                                 .done = done,
                                 .weights_version = task.weights_version,
                                 .weights_hash = task.weights_hash};
    assessment.figures = std::move(figures);
    return assessment;
}

}  // namespace bonemill
