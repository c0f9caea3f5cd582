#include "haptic_server/assessment/measures/figure.h"

#include <algorithm>
#include <cmath>

#include "common/base/assert.h"

namespace bonemill {
namespace {

constexpr Definition kDefinitions[] = {
    {"time.session", 1, "Time in all", "s", true},
    {"time.pedal", 1, "Pedal down", "s"},
    {"time.contact", 1, "In contact", "s"},
    {"time.cutting", 1, "Cutting", "s", true},
    {"time.idle", 1, "Without contact", "s"},
    {"time.lost", 1, "Not recorded", "s"},
    {"path.length", 1, "Way of the burr", "mm"},
    {"path.contact", 1, "Way in contact", "mm"},
    {"path.per_volume", 1, "Way per removed volume", "mm/mm3", true},
    {"force.mean", 1, "Force in contact, mean", "N"},
    {"force.median", 1, "Force in contact, median", "N", true},
    {"force.p95", 1, "Force in contact, 95 %", "N", true},
    {"force.max", 1, "Force in contact, largest", "N"},
    {"force.impulse", 1, "Impulse", "N s"},
    {"force.excess", 1, "Contact above the force limit", "percent"},
    {"near.time", 1, "Contact at this distance", "s"},
    {"near.force", 1, "Force at this distance, median", "N"},
    {"near.speed", 1, "Speed in contact at this distance, median", "mm/s"},
    {"removal.volume", 1, "Removed", "mm3", true},
    {"removal.rate", 1, "Removed per time of cutting", "mm3/s", true},
    {"removal.friction_energy", 1, "Work of the burr per removed volume", "J/mm3"},
    {"burr.volume", 1, "Removed with this burr", "mm3"},
    {"burr.share", 1, "Share of this burr", "percent"},
    {"burr.near_share", 1, "Share of this burr below 2 mm", "percent"},
    {"strokes.turns", 1, "Strokes, by turns", ""},
    {"strokes.turns.length", 1, "Length of a stroke, median", "mm", true},
    {"strokes.turns.time", 1, "Time of a stroke, median", "s"},
    {"strokes.turns.speed", 1, "Speed of a stroke, median", "mm/s"},
    {"strokes.turns.force", 1, "Force of a stroke, median", "N"},
    {"strokes.turns.volume", 1, "Removed per stroke, median", "mm3"},
    {"strokes.bouts", 1, "Strokes, by contact", ""},
    {"strokes.bouts.time", 1, "Time of a contact, median", "s"},
    {"strokes.minima", 1, "Strokes, by minima of speed", ""},
    {"strokes.minima.length", 1, "Length between minima, median", "mm"},
    {"smooth.sparc", 1, "Smoothness of a stroke, SPARC, median", ""},
    {"smooth.ldlj", 1, "Smoothness of a stroke, LDLJ, median", ""},
    {"smooth.f95", 1, "Frequency below which 95 % of a stroke's speed lies, median", "Hz"},
    {"angle.normal", 1, "Shaft to the bone's normal, median", "deg"},
    {"angle.view", 1, "Shaft to the line of sight, median", "deg"},
    {"angle.side_share", 1, "Removed with the burr's side", "percent"},
    {"steady.axis", 1, "Unrest of the shaft within a second, median", "deg"},
    {"steady.force", 1, "Unrest of the force within a second, median", "N"},
    {"sight.unseen", 1, "Removed out of sight", "percent", true},
    {"sight.known", 1, "Removed while the eye's place was known", "percent"},
    {"heat.peak", 1, "Hottest bone", "degC", true},
    {"heat.above_47", 1, "Some bone above 47 degC", "s"},
    {"heat.cem43", 1, "Heat dose of the hottest bone, CEM43", "min"},
    {"heat.necrotic", 1, "Bone dead of heat", "mm3"},
    {"damage.episodes", 1, "Times this structure was cut", ""},
    {"damage.volume", 1, "Cut of this structure", "mm3", true},
    {"damage.time", 1, "Time of cutting this structure", "s"},
    {"structure.force", 1, "Largest force on this structure", "N"},
    {"structure.distance", 1, "Least distance to this structure", "mm", true},
};

// The definition of a figure, which may be of one structure or burr.
const Definition* definitionOf(const Figure& figure) {
    const std::string_view id = std::string_view(figure.id).substr(0, figure.id.find(':'));
    const auto* const found =
        std::ranges::find_if(kDefinitions, [&](const Definition& known) { return id == known.id; });
    return found == std::end(kDefinitions) ? nullptr : found;
}

bool isShownElsewhere(const Assessment& assessment, const Figure& figure) {
    return std::ranges::any_of(assessment.gates,
                               [&](const GateResult& gate) { return gate.figure_id == figure.id; }) ||
           std::ranges::any_of(assessment.sub_scores,
                               [&](const SubScore& score) { return score.figure.id == figure.id; });
}

}  // namespace

std::vector<const Figure*> firstFigures(const Assessment& assessment) {
    std::vector<const Figure*> first;
    for (const Figure& figure : assessment.figures) {
        const Definition* definition = definitionOf(figure);
        if (!definition || !definition->is_first || isShownElsewhere(assessment, figure)) continue;
        if (first.size() < kMostFirst) first.push_back(&figure);
    }
    return first;
}

std::vector<const Figure*> otherFigures(const Assessment& assessment) {
    const std::vector<const Figure*> first = firstFigures(assessment);
    std::vector<const Figure*> others;
    for (const Figure& figure : assessment.figures)
        if (std::ranges::find(first, &figure) == first.end() && !isShownElsewhere(assessment, figure))
            others.push_back(&figure);
    return others;
}

std::span<const Definition> techniqueDefinitions() {
    return kDefinitions;
}

void put(Figures& figures, std::string_view id, double value, const std::string& of) {
    if (!std::isfinite(value)) return;
    const auto* const found =
        std::ranges::find_if(kDefinitions, [&](const Definition& known) { return id == known.id; });
    BONEMILL_ASSERT(found != std::end(kDefinitions));
    const std::string suffix = of.empty() ? "" : ":" + of;
    const std::string label = of.empty() ? found->label : std::string(found->label) + ": " + of;
    figures.push_back({found->id + suffix, found->version, label, value, found->unit});
}

}  // namespace bonemill
