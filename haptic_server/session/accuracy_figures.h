// What accuracy-report measured for a scene: errors of each accuracy setting, by its name.
#pragma once

#include <map>
#include <string>

namespace bonemill {

struct AccuracyFigure {
    double force_error_percent = 0;
    double direction_error_deg = 0;
};
using AccuracyFigures = std::map<std::string, AccuracyFigure>;

// `file` as accuracy-report writes it (accuracy.json). Throws UserError for a file that is not.
AccuracyFigures readAccuracyFigures(const std::string& file);

// Where the figures of a scene lie if they were kept: beside it, X.textproto -> X.accuracy.json.
std::string accuracyFiguresOf(const std::string& scene_file);

}  // namespace bonemill
