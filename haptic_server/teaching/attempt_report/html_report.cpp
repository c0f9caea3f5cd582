#include "haptic_server/teaching/attempt_report/html_report.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "haptic_server/assessment/measures/moment_finder.h"
#include "haptic_server/teaching/attempt_report/charts.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

// How a report looks, on a screen and on A4. It names no font and no file from elsewhere.
inline constexpr char kReportStyle[] = R"(
@page{size:A4;margin:10mm}
*{box-sizing:border-box}
body{font:8pt/1.3 system-ui,sans-serif;color:#1b1f24;background:#fff;max-width:190mm;margin:0 auto;padding:4mm 0;
print-color-adjust:exact;-webkit-print-color-adjust:exact}
h1{font-size:13pt;margin:0}h2{font-size:8.5pt;margin:0 0 1mm;border-bottom:.3mm solid #d4d8dd}
p{margin:.5mm 0}section{margin:1.8mm 0 0;break-inside:avoid}
header{display:flex;justify-content:space-between;align-items:center;gap:6mm}
.verdict{font-size:11pt;font-weight:600;padding:1.5mm 4mm;border-radius:1.5mm;border:.4mm solid;white-space:nowrap}
.verdict.passed{color:#0b5d33;background:#e5f4ec}.verdict.failed{color:#9b1c1c;background:#fdeaea}
.verdict.none{color:#555;font-weight:400;font-size:9.5pt}
.top{display:flex;gap:5mm;align-items:flex-start}.top>div{flex:1}
table{border-collapse:collapse;width:100%}td,th{padding:.2mm 1mm;text-align:left;vertical-align:top}
th{font-weight:400;color:#59626c}.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
.gates td:first-child{white-space:nowrap;font-weight:600}.gates .passed td:first-child{color:#0b5d33}
.gates .failed td{color:#9b1c1c}.scores td:first-child{width:40%}.scores .score{width:30mm}.scores svg{height:2.4mm;width:30mm}
.total{margin-top:1mm}
.pictures{width:46mm;flex:none}figure{margin:0}figure img{width:100%;max-height:46mm;object-fit:contain}
figcaption{font-size:7.5pt;color:#59626c}
svg{width:100%;height:auto;display:block}svg text{font-size:8px;fill:#59626c;font-family:inherit}
svg .title{fill:#1b1f24}svg .frame{fill:none;stroke:#c9ced4;stroke-width:.7}
svg path{fill:none;stroke-width:1.2;stroke-linejoin:round;stroke-linecap:round}
svg .force{stroke:#14508c}svg .peak{stroke:#14508c;stroke-width:.5;opacity:.6}svg .removed{stroke:#6b4a1e}
svg .distance{stroke:#0b5d33}svg .heat{stroke:#9b1c1c}svg .curve{stroke:#14508c;stroke-dasharray:3 2}
svg path.mark{stroke:#9b1c1c;stroke-width:.7;stroke-dasharray:2 2}svg circle.mark{fill:#9b1c1c}
svg .number{fill:#fff;font-weight:600}svg .bar{fill:#14508c}svg .band{fill:#cfdceb}
svg .dot{fill:#fff;stroke:#14508c;stroke-width:1.2}svg .dot.last{fill:#14508c}
.moments td{padding:.2mm 1.2mm}.moments .mark{color:#9b1c1c;font-weight:600;width:5mm}
code{font:7pt ui-monospace,monospace;color:#59626c}
.charts{display:flex;flex-wrap:wrap;gap:3mm}.charts figure{width:60mm}
.all{columns:3;column-gap:4mm;break-inside:auto}.first{columns:2;column-gap:6mm}
summary{cursor:pointer;font-weight:600;color:#59626c}
.first .figures{font-size:8pt}.all .figures{font-size:5.6pt;line-height:1.12}.figures td:first-child{width:100%}.figures tr{break-inside:avoid}.figures td{padding:.05mm .4mm;border-bottom:.1mm solid #e6e9ec}
.figures .id{color:#8a929b}.far{font-weight:700}
footer{margin-top:1.5mm;font-size:6pt;color:#59626c}
@media screen{body{padding:8mm}}
)";

constexpr size_t kWorst = 3;
constexpr size_t kMaxShownFigures = 120;
constexpr size_t kMaxPictureBytes = size_t(4) << 20;

std::string verdictOf(const Assessment& assessment) {
    if (assessment.gates.empty()) return element("p", "No gates in this task", "class='verdict none'");
    const auto failed = std::ranges::count(assessment.gates, false, &GateResult::is_passed);
    if (failed == 0) return element("p", "Passed", "class='verdict passed'");
    return element(
        "p",
        "Not passed: " + std::to_string(failed) + " of " + std::to_string(assessment.gates.size()) + " gates",
        "class='verdict failed'");
}

std::string titleOf(const AttemptResult& result) {
    const std::string facts = element("b", escaped(result.pseudonym)) + " · attempt " +
                              std::to_string(result.number) + " · " + escaped(utcText(result)) + " · " +
                              clockText(result.duration_s) + (result.is_exam ? " · examination" : "");
    return element("header",
                   element("div", element("h1", escaped(result.scene_title)) + element("p", facts)) +
                       verdictOf(result.assessment));
}

std::string gatesOf(const Assessment& assessment) {
    std::string rows;
    for (const GateResult& gate : assessment.gates)
        rows += element("tr",
                        element("td", gate.is_passed ? "✓ passed" : "✗ failed") +
                            element("td", escaped(gate.label)) + element("td", escaped(gate.text)),
                        gate.is_passed ? "class='passed'" : "class='failed'");
    return rows.empty()
               ? ""
               : element("section", element("h2", "Gates") + element("table", rows, "class='gates'"));
}

std::string totalOf(const Assessment& assessment) {
    if (!assessment.total) return "";
    const Total& total = *assessment.total;
    return element("p",
                   "Total " + element("b", roundedText(100 * total.score) + " of 100") +
                       " with the teacher's weights, version " + std::to_string(total.weights_version) +
                       " (" + escaped(total.weights_hash) + "); " + roundedText(100 * total.done) +
                       " % of what was asked to be removed is gone",
                   "class='total'");
}

std::string subScoresOf(const Assessment& assessment) {
    std::string rows;
    for (const SubScore& sub : assessment.sub_scores) {
        const std::string limits = roundedText(sub.worst) + " → " + valueText(sub.best, sub.figure.unit);
        rows += element(
            "tr", element("td", escaped(sub.label)) +
                      element("td", escaped(valueText(sub.figure.value, sub.figure.unit)), "class='n'") +
                      element("td", escaped(limits), "class='n'") +
                      element("td", scoreBarSvg(sub.score), "class='score'") +
                      element("td", roundedText(100 * sub.score), "class='n'"));
    }
    if (rows.empty()) return "";
    const std::string head = element(
        "tr",
        "<th></th><th class='n'>measured</th><th class='n'>0 → 100 at</th><th></th><th class='n'>score</th>");
    return element("section", element("h2", "Scores") + element("table", head + rows, "class='scores'") +
                                  totalOf(assessment));
}

std::string picturesOf(const std::vector<ReportPicture>& pictures) {
    std::string out;
    for (const ReportPicture& picture : pictures) {
        const bool is_known = picture.media_type == "image/png" || picture.media_type == "image/svg+xml";
        if (!is_known || picture.data.size() > kMaxPictureBytes) continue;
        out += element("figure", "<img alt='" + escaped(picture.caption) +
                                     "' src='data:" + picture.media_type + ";base64," + base64(picture.data) +
                                     "'>" + element("figcaption", escaped(picture.caption)));
    }
    return out.empty() ? "" : element("section", out, "class='pictures'");
}

std::string worstMomentsOf(const std::vector<Moment>& worst, double begin_s) {
    std::string rows;
    for (size_t n = 0; n < worst.size(); ++n)
        rows += element("tr",
                        element("td", std::to_string(n + 1), "class='mark'") +
                            element("td", clockText(worst[n].t_s - begin_s), "class='n'") +
                            element("td", escaped(worst[n].text)) +
                            element("td", element("code", "--at " + coordinate(worst[n].t_s)), "class='n'"));
    return rows.empty() ? "" : element("table", rows, "class='moments'");
}

std::string timeLineOf(const AttemptResult& result, double begin_s) {
    const std::vector<Moment> worst = worstOf(result.assessment.moments, kWorst);
    const std::string replay =
        result.journal.empty()
            ? ""
            : " · " + element("code", "bonemill replay " + escaped(result.journal) + " --at …");
    const std::string proof = result.chain.empty()
                                  ? ""
                                  : element("p", "The recording's chain at the end of the attempt: " +
                                                     element("code", escaped(result.chain)));
    const std::string line = timeLineSvg(result.assessment, worst, begin_s);
    if (line.empty() && worst.empty() && proof.empty()) return "";
    return element("section", element("h2", "The attempt, and its worst moments" + replay) + line +
                                  worstMomentsOf(worst, begin_s) + proof);
}

// Scores where there are some, else the time that it took.
std::string attemptsOf(const std::vector<AttemptResult>& own) {
    if (own.size() < 2) return "";
    const bool have_totals = std::ranges::all_of(
        own, [](const AttemptResult& result) { return result.assessment.total.has_value(); });
    std::vector<double> values;
    for (const AttemptResult& result : own)
        values.push_back(have_totals ? 100 * result.assessment.total->score : result.duration_s);
    const std::optional<LearningCurve> curve = fitLearningCurve(values);
    const std::string unit = have_totals ? "" : "s";
    std::string words = have_totals ? "Total score by attempt." : "Time by attempt.";
    if (own.size() >= 3) {
        const double mean =
            (values[values.size() - 1] + values[values.size() - 2] + values[values.size() - 3]) / 3;
        words += " Mean of the last three: " + valueText(mean, unit) + ".";
    }
    if (curve)
        words += " The curve goes from " + valueText(curve->first, unit) + " towards " +
                 valueText(curve->limit, unit) + "; attempts scatter by " +
                 valueText(curve->deviation, unit) + ".";
    return element("figure", attemptsSvg(values, unit, curve) + element("figcaption", escaped(words)));
}

std::string comparedOf(const AttemptResult& result, const ReportExtras& extras) {
    std::string out = attemptsOf(extras.own);
    if (extras.comparison) {
        for (const char* column : {"force", "path", "time"}) {
            const std::string chart = envelopeSvg(result.assessment, *extras.comparison, column);
            if (chart.empty()) continue;
            out += element(
                "figure",
                chart + element("figcaption", "Fifths of what was removed; band: mean ± 2 SD of " +
                                                  std::to_string(extras.comparison->experts) + " experts"));
        }
    }
    return out.empty() ? ""
                       : element("section", element("h2", "Beside other attempts") +
                                                element("div", out, "class='charts'"));
}

std::string zOf(const std::optional<ExpertComparison>& comparison, const std::string& id) {
    if (!comparison) return "";
    const auto found = std::ranges::find(comparison->figures, id, &ComparedFigure::id);
    if (found == comparison->figures.end()) return element("td", "");
    char text[32];
    std::snprintf(text, sizeof text, "%+.1f", found->z);
    return element("td", text, std::abs(found->z) > 2 ? "class='n far'" : "class='n'");
}

std::string figureTable(std::span<const Figure* const> figures, const ReportExtras& extras) {
    std::string rows;
    for (const Figure* figure : figures.first(std::min(figures.size(), kMaxShownFigures)))
        rows +=
            element("tr", element("td", escaped(figure->label)) +
                              element("td", escaped(valueText(figure->value, figure->unit)), "class='n'") +
                              zOf(extras.comparison, figure->id) +
                              element("td", "@" + std::to_string(figure->version),
                                      "class='id' title='" + escaped(figure->id) + "@" +
                                          std::to_string(figure->version) + "'"));
    return element("table", rows, "class='figures'");
}

// What matters first, and the rest folded; gates and scores have theirs already.
std::string figuresOf(const AttemptResult& result, const ReportExtras& extras) {
    const std::vector<const Figure*> first = firstFigures(result.assessment),
                                     others = otherFigures(result.assessment);
    const std::string z = extras.comparison ? " · z: standard deviations from the experts' mean" : "";
    std::string out;
    if (!first.empty())
        out += element("section", element("h2", "How it was done" + z) +
                                      element("div", figureTable(first, extras), "class='first'"));
    if (!others.empty())
        out += element("section",
                       element("details", element("summary",
                                                  "All other figures, with their "
                                                  "definitions' versions") +
                                              element("div", figureTable(others, extras), "class='all'")));
    return out;
}

std::string footOf(const AttemptResult& result) {
    return element(
        "footer",
        "Scene " + escaped(result.scene_id) + ", hash " + escaped(result.scene_hash) +
            ". One attempt says little: judge by the mean of three or more. What each figure is, and "
            "what it does not say: docs/reference/assessment.md. bonemill is no medical device.");
}

}  // namespace

std::string pageHead(const std::string& title) {
    return "<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'>"
           "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src "
           "'unsafe-inline'; img-src data:\">"
           "<meta name='viewport' content='width=device-width'>" +
           element("title", escaped(title)) + element("style", kReportStyle) + "</head><body>";
}

std::string htmlReport(const AttemptResult& result, const ReportExtras& extras) {
    const Assessment& assessment = result.assessment;
    return pageHead(result.scene_title + ", " + result.pseudonym) + titleOf(result) +
           element(
               "div",
               element("div", gatesOf(assessment) + subScoresOf(assessment)) + picturesOf(extras.pictures),
               "class='top'") +
           timeLineOf(result, extras.begin_s) + comparedOf(result, extras) + figuresOf(result, extras) +
           footOf(result) + "</body></html>\n";
}

}  // namespace bonemill
