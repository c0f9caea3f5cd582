#include "haptic_server/teaching/study_report/plan_text.h"

#include <cmath>

#include "haptic_server/teaching/study_report/number_text.h"
#include "haptic_server/teaching/study_statistics/planning.h"

namespace bonemill::study {
namespace {

std::string groupsText(const Plan& plan) {
    return std::to_string(plan.first) + " and " + std::to_string(plan.second) + " people";
}

// The figure of the next line of the text.
std::string seesText(const Plan& plan, double alpha) {
    const double d = smallestDetectableD(plan.first, plan.second, alpha, plan.power);
    if (std::isnan(d)) return "no difference at all";
    return "differences of " + fixedText(d, 2) + " standard deviations or more";
}

std::string testsText(const Plan& plan) {
    if (plan.tests < 2) return "";
    const double tests = double(plan.tests);
    return "- " + std::to_string(plan.tests) + " tests at " + pText(plan.alpha) +
           ": if nothing differs at all, the chance of at least one false alarm is " +
           percentText(falseAlarmChance(plan.tests, plan.alpha)) + " (of independent tests).\n" +
           "- Holm's adjustment holds it at " + pText(plan.alpha) + ": the smallest P counts only below " +
           fixedText(plan.alpha / tests, 4).substr(1) + ", and there the groups show " +
           seesText(plan, plan.alpha / tests) + ".\n";
}

std::string neededText(const Plan& plan) {
    std::string text = "- For this power in one test each group would need";
    for (const double d : {0.5, 0.8, 1.0}) {
        const size_t needed = neededPerGroup(d, plan.alpha, plan.power);
        text += (d > 0.5 ? "; " : " ") + std::to_string(needed) + " people for " + fixedText(d, 1) +
                " standard deviations";
    }
    return text + ".\n";
}

std::string printedText(const Plan& plan) {
    if (!plan.p) return "";
    const double d = impliedD(*plan.p, plan.first, plan.second);
    const double limit = plan.alpha / double(plan.tests);
    return "- P = " + pText(*plan.p) + " of Student's test of these groups is a difference of " +
           fixedText(d, 2) + " standard deviations; true ones from " +
           intervalText(intervalOfD(d, plan.first, plan.second), 2) + " go with it (95 %). " +
           (*plan.p <= limit ? "It stands after Holm's adjustment.\n"
                             : "As the smallest of " + std::to_string(plan.tests) +
                                   " it does not stand after Holm's adjustment: " + pText(*plan.p) +
                                   " times " + std::to_string(plan.tests) + " is " +
                                   pText(std::min(1.0, *plan.p * double(plan.tests))) + ".\n");
}

}  // namespace

std::string planText(const Plan& plan) {
    return "- One test of " + groupsText(plan) + " at " + pText(plan.alpha) + " shows, with a power of " +
           percentText(plan.power) + ", " + seesText(plan, plan.alpha) +
           " (Student's test, equal variances). Smaller ones it will mostly miss, and \"not significant\" "
           "then says "
           "nothing.\n" +
           neededText(plan) + testsText(plan) + printedText(plan);
}

}  // namespace bonemill::study
