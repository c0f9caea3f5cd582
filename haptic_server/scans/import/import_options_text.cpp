#include "haptic_server/scans/import/import_options_text.h"

#include <nlohmann/json.hpp>

namespace bonemill {

using nlohmann::json;

std::string textOfOptions(const ImportOptions& options) {
    json text = {{"series_uid", options.series_uid},
                 {"acquisition", options.acquisition},
                 {"surface_value", options.surface_value}};
    if (options.surface_voxel_mm) text["surface_voxel_mm"] = *options.surface_voxel_mm;
    if (options.spacing_mm)
        text["spacing_mm"] = {options.spacing_mm->x(), options.spacing_mm->y(), options.spacing_mm->z()};
    return text.dump(-1, ' ', false, json::error_handler_t::replace);  // no UID has what is replaced
}

ImportOptions optionsFromText(const std::string& text) {
    const json from = json::parse(text);
    ImportOptions options;
    options.series_uid = from.at("series_uid").get<std::string>();
    options.acquisition = from.at("acquisition").get<std::string>();
    options.surface_value = from.at("surface_value").get<double>();
    if (from.contains("surface_voxel_mm")) options.surface_voxel_mm = from["surface_voxel_mm"].get<double>();
    if (from.contains("spacing_mm")) {
        const json& mm = from["spacing_mm"];
        options.spacing_mm =
            Eigen::Vector3d(mm.at(0).get<double>(), mm.at(1).get<double>(), mm.at(2).get<double>());
    }
    return options;
}

}  // namespace bonemill
