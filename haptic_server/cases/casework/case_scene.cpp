#include "haptic_server/cases/casework/case_scene.h"

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kViewAside = 30, kViewUp = 12,
                 kMostElevation = 80;  // deg, so that the tool does not hide its place
constexpr double kViewOfRegion = 2.2;  // distances of its edge
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

std::string taskOf(const CaseRequest& request) {
    if (request.credit.empty()) return request.task;
    return request.task + (request.task.empty() ? "" : " ") + "Scan: " + request.credit;
}

// Its neutral pose holds the burr on the bone, the shaft towards the hand.
void describeHand(const CasePlan& plan, scene::Device* device) {
    assign(plan.start, device->mutable_p_wd_mm());
    const auto q = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), plan.outwards);
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
    if (!plan.region) return;
    assign(plan.start, camera->mutable_target_mm());
    camera->set_distance_mm(kViewOfRegion * request.size_mm);
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

}  // namespace

scene::Scene sceneOfCase(const CasePlan& plan, const CaseRequest& request,
                         const std::vector<CaseLabel>& labels, const std::vector<scene::Tool>& tools,
                         const std::string& name) {
    scene::Scene scene;
    scene.set_name(name);
    if (!request.title.empty()) scene.set_title(request.title);
    if (const std::string task = taskOf(request); !task.empty()) scene.set_task(task);
    describeVolume(plan, request, !request.labels.empty(), scene.mutable_volume());
    for (const scene::Tool& tool : tools) *scene.add_tool() = tool;
    describeEffects(tools, scene.mutable_effects());
    describeStructures(labels, scene);
    describeHand(plan, scene.mutable_device());
    describeView(plan, request, scene.mutable_camera());
    return scene;
}

std::string textOfScene(const scene::Scene& scene) {
    std::string text;
    google::protobuf::TextFormat::PrintToString(scene, &text);
    return "# A case made of a scan (docs/teach/cases.md). docs/lab/scene.md has every field with its unit, "
           "default "
           "and range.\n" +
           text;
}

}  // namespace bonemill
