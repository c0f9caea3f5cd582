#include "haptic_server/cases/casework/make_case.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/digest/digest.h"
#include "common/files/require_file.h"
#include "haptic_server/cases/casework/case_figures.h"
#include "haptic_server/cases/casework/case_scene.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_stream.h"
#include "haptic_server/scene/setup/scene_region.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// Takes the place of the case when it is whole; else it goes.
class CaseFolder {
  public:
    explicit CaseFolder(const fs::path& path) : path_(fs::absolute(path).lexically_normal()) {
        if (path_.filename().empty()) path_ = path_.parent_path();
        std::error_code error;
        if (fs::exists(path_, error) && (!fs::is_directory(path_, error) || !fs::is_empty(path_, error)))
            throw UserError(path.string() + ": is there already; give --out a new folder");
        part_ = path_.parent_path() / (".part_" + path_.filename().string());
        fs::remove_all(part_, error);
        if (!fs::create_directories(part_, error))
            throw UserError(path.string() + ": cannot be made (" + error.message() + ")");
    }
    ~CaseFolder() {
        std::error_code ignored;
        if (!is_finished_) fs::remove_all(part_, ignored);
    }
    CaseFolder(const CaseFolder&) = delete;
    CaseFolder& operator=(const CaseFolder&) = delete;

    std::string name() const { return path_.filename().string(); }
    fs::path operator/(const std::string& file) const { return part_ / file; }
    void finish() {
        std::error_code error;
        fs::remove(path_, error);
        fs::rename(part_, path_);
        is_finished_ = true;
    }

  private:
    fs::path path_, part_;
    bool is_finished_ = false;
};

void writeVolume(const fs::path& file, const RawVolume& volume) {
    volume.values.visit([&]<class T>(std::span<const T> samples) {
        NrrdStream<T> stream(file, volume.geometry, NrrdEncoding::kGzip, volume.lacks_patient_axes);
        stream.append(samples);
        stream.close();
    });
}

void writeText(const fs::path& file, const std::string& text) {
    std::ofstream out(file);
    if (!(out << text << std::flush))
        throw UserError(file.string() + ": cannot be written; is the disk full?");
}

std::vector<scene::Tool> toolsOfFile(const std::string& file) {
    if (file.empty()) return {};
    requireFile(file);
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const scene::Scene scene = parseSceneText(text, file).scene;  // the case's own check comes with its scene
    for (const scene::Tool& tool : scene.tool())
        if (tool.has_mesh_path())
            throw UserError(file + ": tools with a mesh_path cannot be taken into a case");
    if (scene.tool_size() == 0) throw UserError(file + ": holds no tool");
    return {scene.tool().begin(), scene.tool().end()};
}

std::string provenanceOf(const RawVolume& scan, const CasePlan& plan, const CaseRequest& request,
                         const fs::path& file, const std::string& version) {
    const std::time_t now = std::time(nullptr);
    char day[16];
    std::strftime(day, sizeof day, "%Y-%m-%d", std::gmtime(&now));
    const auto numbers = [](const auto& v) { return nlohmann::json{v.x(), v.y(), v.z()}; };
    nlohmann::json json;
    json["made"] = day;
    json["by"] = version;
    json["scan"] = {{"voxels", numbers(scan.geometry.dims)},
                    {"voxel_mm", numbers(Eigen::Vector3d(scan.geometry.spacing * kPerMillimetre))},
                    {"hounsfield_units", scan.is_hounsfield},
                    {"patient_axes_known", !scan.lacks_patient_axes},
                    {"sha256", sha256OfFile(file)}};
    json["iso_value"] = plan.mapping.iso_value;
    if (plan.mapping.proposed) json["iso_value_proposed"] = textOf(*plan.mapping.proposed);
    if (!request.credit.empty()) json["credit"] = request.credit;
    json["left_out"] = "name, dates, identifiers and all other text of the scan's file";
    return json.dump(2) + "\n";
}

void checkLabels(const CaseRequest& request, const std::vector<CaseLabel>& labels) {
    if (request.labels.empty() && !labels.empty())
        throw UserError("--label needs a label map: --labels FILE");
    if (!request.labels.empty() && labels.empty())
        throw UserError(
            "--labels needs at least one --label NUMBER=NAME, or --label NAME where the file names its "
            "segments");
}

bool isUtf8(const std::string& text) {
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

// Before anything is read: what is typed goes into texts that are UTF-8, and the folder's name into one of a
// picture beside the others.
void requireTexts(const CaseRequest& request) {
    std::vector<std::pair<std::string, std::string>> texts = {{"--title", request.title},
                                                              {"--task", request.task},
                                                              {"--credit", request.credit},
                                                              {"--out", request.out}};
    for (const std::string& word : request.label_words) texts.emplace_back("--label", word);
    for (const auto& [option, text] : texts)
        if (!isUtf8(text))
            throw UserError(option + ": the text is not UTF-8; type it in a terminal that writes it");
    const std::string name = fs::path(request.out).lexically_normal().filename().string();
    for (const char* const picture : {"preview", "pieces", "histogram"})
        if (name == picture)
            throw UserError("--out " + request.out +
                            ": a case of this name would have two pictures of one name");
}

void checkDroppedPieces(const CaseRequest& request, const VolumeGeometry& scan) {
    if (!request.at_mm.empty() && !request.drop_pieces.empty() && hasCoarsePieces(scan))
        throw UserError(
            "--drop-piece: a scan this large has its pieces counted on coarser voxels when only a part of it "
            "is "
            "milled; leave it away, and write drop_piece with the numbers of --describe-scene into the "
            "scene");
}

ImportOptions optionsOf(const CaseRequest& request) {
    ImportOptions options{request.series, request.acquisition};
    if (const auto& mm = request.spacing_mm; !mm.empty())
        options.spacing_mm = Eigen::Vector3d(mm[0], mm[1], mm[2]);
    return options;
}

}  // namespace

void makeCase(const CaseRequest& request, const std::string& version, std::ostream& out) {
    requireTexts(request);
    std::vector<CaseLabel> labels = labelsOf(request.label_words);
    checkLabels(request, labels);
    const std::vector<scene::Tool> tools = toolsOfFile(request.tools);
    CaseFolder folder(request.out);
    const RawVolume scan = importVolume(request.scan, optionsOf(request));
    out << scan.description << '\n';
    checkDroppedPieces(request, scan.geometry);
    const CasePlan plan = planCase(scan, request);
    for (const std::string& remark : plan.remarks) out << remark << '\n';
    if (!request.figures.empty()) writeFigures(request.figures, scan, plan);
    writeVolume(folder / kScanOfCase, scan);
    if (!request.labels.empty()) {
        const RawVolume map = importVolume(request.labels);
        findSegments(map.segments, request.labels, labels);
        writeVolume(folder / kLabelsOfCase, map);
    }
    const std::string scene_file = folder.name() + ".textproto";
    writeText(folder / scene_file, textOfScene(sceneOfCase(plan, request, labels, tools, folder.name())));
    writeText(folder / "provenance.json", provenanceOf(scan, plan, request, folder / kScanOfCase, version));
    const Simulation simulation = makeSimulation(loadScene(folder / scene_file));  // as a session would
    for (const std::string& remark : simulation.remarks) out << remark << '\n';
    for (const std::string& warning : simulation.warnings) out << "warning: " << warning << '\n';
    folder.finish();
    out << "wrote " << (fs::path(request.out) / scene_file).string() << '\n';
}

}  // namespace bonemill
