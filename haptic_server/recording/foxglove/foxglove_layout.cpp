#include "haptic_server/recording/foxglove/foxglove_layout.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"

namespace bonemill {
namespace {

using nlohmann::json;

// Foxglove's own are made for vehicles: its nearest plane is half a metre away, and its axes are a metre
// long.
json sceneOf(const std::vector<std::string>& topics, const Eigen::Vector3d& center, double size) {
    json shown = json::object();
    for (const std::string& topic : topics)
        if (topic.starts_with("/bone/") || topic == "/force" || topic == "/tool/shape" ||
            topic == "/structures")
            shown[topic] = {{"visible", true}};
    for (const char* const pose : {"/tool/pose", "/hand/pose"})
        shown[pose] = {{"visible", false}, {"type", "axis"}, {"axisScale", 0.2 * size}};
    return {{"followMode", "follow-none"},
            {"followTf", "W"},
            {"cameraState",
             {{"perspective", true},
              {"distance", 1.5 * size},
              {"phi", 60},
              {"thetaOffset", 45},
              {"targetOffset", {center.x(), center.y(), center.z()}},
              {"target", {0, 0, 0}},
              {"targetOrientation", {0, 0, 0, 1}},
              {"fovy", 45},
              {"near", 0.01 * size},
              {"far", 100 * size}}},
            {"scene", {{"transforms", {{"axisScale", 0.1 * size}, {"labelSize", 0.02 * size}}}}},
            {"transforms", {{"frame:V", {{"visible", false}}}, {"frame:D", {{"visible", false}}}}},
            {"topics", shown},
            {"layers", json::object()}};
}

json plotOf(const std::string& title, const std::vector<std::string>& numbers) {
    json paths = json::array();
    for (const std::string& number : numbers)
        paths.push_back({{"value", "/tick." + number},
                         {"label", number},
                         {"enabled", true},
                         {"timestampMethod", "receiveTime"}});
    return {{"foxglovePanelTitle", title}, {"paths", paths},          {"showLegend", true},
            {"xAxisVal", "timestamp"},     {"isSynced", true},        {"legendDisplay", "floating"},
            {"showXAxisLabels", true},     {"showYAxisLabels", true}, {"showPlotValuesInLegend", true}};
}

json side(const json& first, const json& second, const char* direction, int percent) {
    return {{"first", first}, {"second", second}, {"direction", direction}, {"splitPercentage", percent}};
}

}  // namespace

void writeFoxgloveLayout(const std::string& path, const std::vector<std::string>& topics,
                         const Eigen::Vector3d& center, double size) {
    const json layout = {
        {"configById",
         {{"3D!bone", sceneOf(topics, center, size)},
          {"Plot!force", plotOf("Force on the hand, N", {"force_n", "force_x_n", "force_y_n", "force_z_n"})},
          {"Plot!removed", plotOf("Bone removed, mm³", {"removed_sum_mm3"})},
          {"RosOut!log", {{"topicToRender", "/log"}, {"searchTerms", json::array()}, {"minLogLevel", 1}}},
          {"RawMessages!cuts", {{"topicPath", "/cuts"}, {"diffEnabled", false}}}}},
        {"globalVariables", json::object()},
        {"userNodes", json::object()},
        {"playbackConfig", {{"speed", 1}}},
        {"layout", side("3D!bone",
                        side(side("Plot!force", "Plot!removed", "column", 60),
                             side("RosOut!log", "RawMessages!cuts", "row", 60), "column", 60),
                        "row", 55)}};
    WholeFile file(path);
    std::ofstream out(file.part());
    out << layout.dump(2) << '\n';
    out.close();
    if (!out) throw UserError(path + ": cannot be written to its end (disk full?)");
    file.finish();
}

}  // namespace bonemill
