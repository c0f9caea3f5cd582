// The words in which an attempt is judged, shared by all who measure and all who show: figures, gates,
// sub-scores, and what they come to.
//
// Figures leave the program, so that their values have the unit that `unit` names, never SI by silence. They
// are plain values; any thread may hold its own.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bonemill {

// One measured number. `id` and `version` name its definition (docs/reference/assessment.md): a definition
// that changes gets another version, and figures of different versions are never compared.
struct Figure {
    std::string id;  // "force.p95"; a figure of one structure or burr ends in its name: "damage.volume:nerve"
    int version = 1;    // of the definition, from 1
    std::string label;  // for people: "Force in contact, 95 %"
    double value = 0;   // finite; what has no value in this attempt is not in the list
    std::string unit;   // "mm3", "percent", "s", "N", "mm", "N s", "mm/s", "deg", ...; "" for a plain number
};
using Figures = std::vector<Figure>;

// Units for people: figures have them in ASCII, as "mm3", and texts as "mm³".
inline std::string_view writtenUnit(std::string_view unit) {
    using Pair = std::pair<std::string_view, std::string_view>;
    static constexpr std::array kWritten = {
        Pair("mm3", "mm³"),     Pair("mm2", "mm²"),     Pair("percent", "%"),
        Pair("degC", "°C"),     Pair("deg", "°"),       Pair("N s", "N·s"),
        Pair("mm3/s", "mm³/s"), Pair("J/mm3", "J/mm³"), Pair("mm/mm3", "mm/mm³")};
    for (const auto& [plain, with_signs] : kWritten)
        if (unit == plain) return with_signs;
    return unit;
}

// Returns null if there is none of that id. With `version` 0 any version will do.
inline const Figure* findFigure(const Figures& figures, const std::string& id, int version = 0) {
    for (const Figure& figure : figures)
        if (figure.id == id && (version == 0 || figure.version == version)) return &figure;
    return nullptr;
}

// A limit that must hold, whatever else was good.
struct GateResult {
    std::string id;         // "damage:nerve"
    std::string label;      // for people: "The nerve is whole"
    std::string figure_id;  // of Assessment::figures
    double limit = 0;       // in that figure's unit
    bool is_most = true;    // the figure may be no more than the limit; else no less
    bool is_passed = false;
    std::string text;  // what happened, in one sentence: "0.8 mm3 of the nerve were cut; 0 are allowed"
};

// One figure on a scale from 0 to 1: nothing at `worst` and beyond, everything at `best` and beyond. Either
// may be the larger one.
struct SubScore {
    std::string id, label;
    Figure figure;
    double worst = 0, best = 1;  // in the figure's unit
    double score = 0;            // 0 to 1
    double weight = 0;           // the teacher's; 0: it counts for nothing in the total
};

// There is one only where the teacher gave weights.
struct Total {
    double score = 0;  // 0 to 1
    double done = 1;   // share of the target that was reached, 0 to 1
    int weights_version = 0;
    std::string weights_hash;  // 16 hexadecimal digits of what the scene says of weights and limits
};

// One quantity over an attempt. Series of one table have equally many values; NaN: none at that place.
struct Series {
    std::string id, label, unit;
    std::vector<double> values;
};
struct SeriesTable {
    std::string id;  // "second", "bucket"
    Series index;    // the time, or the removed volume, at the end of each step
    std::vector<Series> columns;
};

// Something that happened, for the time-line; the worst of them are shown first.
struct Moment {
    double t_s = 0;    // of the session: what `seek` takes
    std::string kind;  // "damage", "force", "heat", "unseen", "breach"
    std::string text;
    double severity = 0;  // among all kinds: 1 is a limit reached
};

struct Assessment {
    std::vector<GateResult> gates;
    Figures figures;
    std::vector<SubScore> sub_scores;
    std::optional<Total> total;
    std::vector<SeriesTable> series;
    std::vector<Moment> moments;  // in the order of time

    bool hasPassed() const {
        for (const GateResult& gate : gates)
            if (!gate.is_passed) return false;
        return true;
    }
};

// The list of what is measured of technique: each figure's name, version, words and unit, once. What the
// formulas are stands in docs/reference/assessment.md, and a definition that changes there gets another
// version here.
struct Definition {
    const char* id;
    int version;
    const char* label;
    const char* unit;
    bool is_first = false;  // among the figures that people look at first
};

std::span<const Definition> techniqueDefinitions();

// Of these figures those that people look at first, without what the assessment shows already as a gate or a
// score; at most kMostFirst.
inline constexpr size_t kMostFirst = 10;
std::vector<const Figure*> firstFigures(const Assessment& assessment);
// All the others, likewise.
std::vector<const Figure*> otherFigures(const Assessment& assessment);

// Adds the figure of this definition, whose value is in the definition's unit; `of` is the burr, structure or
// range that it is about, if it is about one. A value that is not finite has nothing to say and is left out.
void put(Figures& figures, std::string_view id, double value, const std::string& of = "");

}  // namespace bonemill
