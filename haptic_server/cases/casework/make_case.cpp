#include <google/protobuf/text_format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/digest/digest.h"
#include "common/files/require_file.h"
#include "common/geometry/pose.h"
#include "common/text/printed_text.h"
#include "haptic_server/cases/casework/case_figures.h"
#include "haptic_server/cases/casework/case_plan.h"
#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/scene/setup/scene_region.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "proto/scene.pb.h"

namespace bonemill {
namespace {

constexpr char kScanOfCase[] = "scan.nrrd", kLabelsOfCase[] = "labels.nrrd";

constexpr double kViewAside = 30, kViewUp = 12,
                 kMostElevation = 80;  // deg, so that the tool does not hide its place
constexpr double kViewOfRegion = 2.2;  // distances of its edge
constexpr double kViewOfBurr = 40;     // of its radius
constexpr double kWarningMm = 2;

void assign(const Eigen::Vector3d& p, scene::Vec3* out) {
    const auto rounded = [](double metres) { return std::round(metres * kPerMillimetre * 1e3) / 1e3; };
    out->set_x(rounded(p.x()));
    out->set_y(rounded(p.y()));
    out->set_z(rounded(p.z()));
}

void describeVolume(const CasePlan& plan, const CaseRequest& request, bool has_labels,
                    scene::Volume* volume) {
    volume->set_path(kScanOfCase);
    volume->set_iso_value(plan.mapping.iso_value);
    if (has_labels) volume->set_label_path(kLabelsOfCase);
    if (plan.smallest_piece_voxels > 1) volume->set_smallest_piece_voxels(plan.smallest_piece_voxels);
    for (const uint32_t piece : request.drop_pieces) volume->add_drop_piece(piece);
    if (!plan.region) return;
    assign(plan.region->min(), volume->mutable_region()->mutable_min_mm());
    assign(plan.region->max(), volume->mutable_region()->mutable_max_mm());
    if (request.voxel_mm) volume->mutable_region()->set_resample_mm(*request.voxel_mm);
}

// Whoever mills reads it beside the scene.
std::string taskOf(const CasePlan& plan, const CaseRequest& request) {
    std::string task = request.task;
    const auto add = [&](const std::string& text) {
        if (!text.empty()) task += (task.empty() ? "" : " ") + text;
    };
    add(burrRemark(plan));
    if (!request.credit.empty()) add("Scan: " + request.credit);
    return task;
}

// The thesis' tool, larger: its shaft and the grid of its distances are as many times as large.
void describeTools(const CasePlan& plan, const std::vector<scene::Tool>& tools, scene::Scene& scene) {
    for (const scene::Tool& tool : tools) *scene.add_tool() = tool;
    if (!plan.burr_radius) return;
    const scene::Tool usual;
    scene::Tool& tool = *scene.add_tool();
    const double radius_mm = *plan.burr_radius * kPerMillimetre;
    tool.set_name(printed("%g mm ball", 2 * radius_mm));
    tool.set_burr_radius_mm(radius_mm);
    tool.set_sdf_spacing_mm(usual.sdf_spacing_mm() * radius_mm / usual.burr_radius_mm());
}

// Its neutral pose holds the burr on the bone, one that is chosen for coarse voxels just above it; the shaft
// points towards the hand.
void describeHand(const CasePlan& plan, scene::Device* device) {
    assign(plan.start + plan.burr_radius.value_or(0) * plan.outwards, device->mutable_p_wd_mm());
    const Eigen::Quaterniond q = rotationBetween(Eigen::Vector3d::UnitY(), plan.outwards);
    device->mutable_q_wd()->set_w(q.w());
    device->mutable_q_wd()->set_x(q.x());
    device->mutable_q_wd()->set_y(q.y());
    device->mutable_q_wd()->set_z(q.z());
}

// Azimuth 0 looks from -y, 90 from +x (common/geometry/view_axes.h).
void describeView(const CasePlan& plan, const CaseRequest& request, scene::Camera* camera) {
    const Eigen::Vector3d& eye = plan.outwards;
    const double azimuth = std::atan2(eye.x(), -eye.y()) / kDegree, elevation = std::asin(eye.z()) / kDegree;
    camera->set_azimuth_deg(std::round(std::remainder(azimuth - kViewAside, 360)));
    camera->set_elevation_deg(std::round(std::clamp(elevation + kViewUp, -kMostElevation, kMostElevation)));
    if (!plan.region && !plan.burr_radius) return;
    assign(plan.start, camera->mutable_target_mm());
    camera->set_distance_mm(plan.region ? kViewOfRegion * request.size_mm
                                        : std::round(kViewOfBurr * *plan.burr_radius * kPerMillimetre));
}

void describeStructures(const std::vector<CaseLabel>& labels, scene::Scene& scene) {
    constexpr std::array<std::array<double, 3>, 5> kColours = {
        {{0.30, 0.35, 0.85}, {1.00, 0.80, 0.10}, {0.78, 0.60, 0.92}, {0.85, 0.35, 0.30}, {0.40, 0.75, 0.55}}};
    size_t colour = 0;
    for (const CaseLabel& label : labels) {
        scene::Material& material = *scene.add_material();
        material.set_name(label.name);
        for (const uint32_t number : label.labels) material.add_label(number);
        const auto& own = kColours[colour++ % kColours.size()];
        const Eigen::Vector3d rgb = label.color.value_or(Eigen::Vector3d(own[0], own[1], own[2]));
        material.mutable_color()->set_red(rgb[0]);
        material.mutable_color()->set_green(rgb[1]);
        material.mutable_color()->set_blue(rgb[2]);
        material.set_is_protected(label.role == CaseLabel::Role::kProtected);
        if (material.is_protected()) {
            scene.mutable_effects()->mutable_protected_structures()->set_warning_distance_mm(kWarningMm);
            scene::Task::Gate& gate = *scene.mutable_assessment()->add_gate();
            gate.set_figure("structure.lost_volume:" + label.name);
            gate.set_at_most(0);
        }
        if (label.role == CaseLabel::Role::kTarget) {
            scene::Task::Zone& zone = *scene.mutable_assessment()->add_zone();
            zone.set_name(label.name);
            zone.set_role(scene::Task::TARGET);
            zone.add_material(label.name);
        }
    }
}

// What every milling of bone has; a burr that turns is what most of it needs.
void describeEffects(const std::vector<scene::Tool>& tools, scene::Effects* effects) {
    const bool all_turn = !tools.empty() && std::ranges::all_of(tools, &scene::Tool::has_speed_rpm);
    if (!all_turn) {
        effects->mutable_time_removal();
        return;
    }
    effects->mutable_energy_removal();
    effects->mutable_cutting_force();
    effects->mutable_surface_friction();
    effects->mutable_burr_vibration();
    effects->mutable_bone_dust();
    effects->mutable_burr_spin();
    effects->mutable_milling_sound();
}

// `tools` may be empty.
scene::Scene sceneOfCase(const CasePlan& plan, const CaseRequest& request,
                         const std::vector<CaseLabel>& labels, const std::vector<scene::Tool>& tools,
                         const std::string& name) {
    scene::Scene scene;
    scene.set_name(name);
    if (!request.title.empty()) scene.set_title(request.title);
    if (const std::string task = taskOf(plan, request); !task.empty()) scene.set_task(task);
    describeVolume(plan, request, !request.labels.empty(), scene.mutable_volume());
    describeTools(plan, tools, scene);
    describeEffects(tools, scene.mutable_effects());
    describeStructures(labels, scene);
    describeHand(plan, scene.mutable_device());
    describeView(plan, request, scene.mutable_camera());
    return scene;
}

// The text that loadScene() reads.
std::string textOfScene(const scene::Scene& scene) {
    std::string text;
    google::protobuf::TextFormat::PrintToString(scene, &text);
    return "# A case made of a scan (docs/howto/cases.md). docs/reference/scene.md has every field with its "
           "unit, "
           "default "
           "and range.\n" +
           text;
}

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
        NrrdStream<T> stream(file, volume.geometry, volume.lacks_patient_axes);
        stream.append(samples);
        stream.close();
    });
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
        out << request.labels << ": " << map.description << '\n';
        findSegments(map.segments, request.labels, labels);
        writeVolume(folder / kLabelsOfCase, map);
    }
    const std::string scene_file = folder.name() + ".textproto";
    writeWhole(folder / scene_file, textOfScene(sceneOfCase(plan, request, labels, tools, folder.name())));
    writeWhole(folder / "provenance.json", provenanceOf(scan, plan, request, folder / kScanOfCase, version));
    const SceneSetup simulation = setUpScene(loadScene(folder / scene_file));  // as a session would
    for (const std::string& remark : simulation.remarks) out << remark << '\n';
    for (const std::string& warning : simulation.warnings) out << "warning: " << warning << '\n';
    folder.finish();
    out << "wrote " << (fs::path(request.out) / scene_file).string() << '\n';
}

}  // namespace bonemill
