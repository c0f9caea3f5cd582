// accuracy-report has measured this for a scene: the errors of each accuracy setting, by its name.
#pragma once

#include <map>
#include <string>

namespace bonemill {

struct AccuracyFigure {
    double force_error_percent = 0;
    double direction_error_deg = 0;
};
using AccuracyFigures = std::map<std::string, AccuracyFigure>;

// `file` is what accuracy-report writes (accuracy.json). Throws UserError for any other file.
AccuracyFigures readAccuracyFigures(const std::string& file);

// The figures of a scene lie there if they were kept: beside the scene, X.textproto -> X.accuracy.json.
std::string accuracyFiguresOf(const std::string& scene_file);

}  // namespace bonemill
