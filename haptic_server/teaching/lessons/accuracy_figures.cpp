#include "haptic_server/teaching/lessons/accuracy_figures.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/text/text_encoding.h"

namespace bonemill {

AccuracyFigures readAccuracyFigures(const std::string& file) {
    requireFile(file);
    std::ifstream stream(file);
    if (!stream) throw UserError(file + ": cannot be read");
    std::string text(std::istreambuf_iterator<char>(stream), {});
    requireUtf8(text, file);
    try {
        AccuracyFigures figures;
        const nlohmann::json json = nlohmann::json::parse(text);
        for (const auto& [name, figure] : json.at("settings").items())
            figures[name] = {figure.at("force_error_percent").get<double>(),
                             figure.at("direction_error_deg").get<double>()};
        return figures;
    } catch (const nlohmann::json::exception& error) {
        throw UserError(file + ": is no accuracy.json of accuracy-report: " + error.what());
    }
}

std::string accuracyFiguresOf(const std::string& scene_file) {
    return std::filesystem::path(scene_file).replace_extension(".accuracy.json").string();
}

}  // namespace bonemill
