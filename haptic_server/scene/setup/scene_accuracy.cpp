#include "haptic_server/scene/setup/scene_accuracy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/base/units.h"
#include "common/config/scene_check.h"
#include "common/config/scene_tools.h"

namespace bonemill {
namespace {

// Presets and laws have the scene's numbers.
using A = scene::Accuracy;
static_assert(int(Preset::kThesis2012) == A::THESIS_2012 && int(Preset::kFast) == A::FAST &&
              int(Preset::kBalanced) == A::BALANCED && int(Preset::kExact) == A::EXACT &&
              int(Preset::kProxy3Dof) == A::PROXY_3DOF && int(Preset::kVps) == A::VPS &&
              int(Preset::kPenaltySdf) == A::PENALTY_SDF && int(Preset::kConstraint) == A::CONSTRAINT &&
              A::Preset_MAX == A::CONSTRAINT);
static_assert(int(ContactLaw::kThesis2012) == A::PENALTY_THESIS_2012 &&
              int(ContactLaw::kGradient) == A::GRADIENT && int(ContactLaw::kProxy3Dof) == A::BALL_PROXY &&
              int(ContactLaw::kVps) == A::VOXMAP_POINT_SHELL &&
              int(ContactLaw::kPenaltySdf) == A::POINT_PENALTY &&
              int(ContactLaw::kConstraint) == A::LEAST_CONSTRAINT &&
              A::ContactLaw_MAX == A::LEAST_CONSTRAINT);

ShellNormals givenNormals(scene::Accuracy::Normals normals) {
    return normals == scene::Accuracy::TRILINEAR ? ShellNormals::kTrilinear
                                                 : ShellNormals::kCentralDifference;
}

GradientContactConfig contactConfigOf(const scene::Contact& contact) {
    return {.stiffness_per_area = contact.stiffness_n_per_mm3() * kPerCubicMillimetre,
            .stiffness_cap = contact.stiffness_cap_n_per_mm() / kMillimetre};
}

}  // namespace

AccuracySettings accuracyOf(const scene::Scene& scene) {
    const scene::Accuracy& knobs = scene.accuracy();
    AccuracySettings settings = presetSettings(Preset(knobs.preset()));
    if (knobs.has_contact_law()) settings.law = ContactLaw(knobs.contact_law());
    if (knobs.has_shell_factor()) settings.shell_factor = int(knobs.shell_factor());
    if (knobs.has_sample_spacing_um()) settings.sample_spacing = knobs.sample_spacing_um() * kMicrometre;
    if (knobs.has_most_samples()) settings.most_samples = int(knobs.most_samples());
    if (knobs.has_tool_distance())
        settings.tool_distance =
            knobs.tool_distance() == scene::Accuracy::GRID ? ToolDistance::kGrid : ToolDistance::kAnalytic;
    if (knobs.has_sdf_refinement()) settings.sdf_refinement = int(knobs.sdf_refinement());
    if (knobs.has_precision())
        settings.precision =
            knobs.precision() == scene::Accuracy::DOUBLE ? Precision::kDouble : Precision::kFloat;
    if (knobs.has_iterations()) settings.iterations = int(knobs.iterations());
    if (knobs.has_continuous_collision()) settings.continuous_collision = knobs.continuous_collision();
    return settings;
}

std::vector<AccuracySettings> accuracyChoices(const scene::Scene& scene) {
    std::vector<AccuracySettings> choices{accuracyOf(scene)};
    if (scene.accuracy().switchable())
        for (const Preset preset : allPresets()) choices.push_back(presetSettings(preset));
    return choices;
}

PresetRule::PresetRule(const scene::Scene& scene)
    : is_switchable_(scene.accuracy().switchable()),
      effect_of_gradient_law_(effectOfGradientLaw(scene.effects())) {}

std::string PresetRule::whyNot(Preset preset) const {
    if (!is_switchable_) return "the scene says accuracy.switchable: false";
    if (presetSettings(preset).law == ContactLaw::kGradient || !effect_of_gradient_law_) return "";
    return std::string("effects.") + effect_of_gradient_law_ +
           " of the scene needs the gradient contact law, which " + std::string(presetName(preset)) +
           " is not";
}

ShellConfig shellConfigOf(const scene::Scene& scene) {
    std::map<int, ShellNormals> normals_of_factor;
    for (const AccuracySettings& choice : accuracyChoices(scene)) {
        ShellNormals& normals =
            normals_of_factor.try_emplace(choice.shell_factor, ShellNormals::kTrilinear).first->second;
        if (choice.law == ContactLaw::kThesis2012) normals = ShellNormals::kCentralDifference;
    }
    for (const int coarser : {2, 3})  // for ticks in which there is no time for the finer ones
        normals_of_factor.try_emplace(coarser, ShellNormals::kTrilinear);
    ShellConfig config{.levels = {}};
    for (const auto& [factor, normals] : normals_of_factor)
        config.levels.push_back(
            {factor, scene.accuracy().has_normals() ? givenNormals(scene.accuracy().normals()) : normals});
    return config;
}

std::vector<int> sdfRefinementsOf(const scene::Scene& scene, const scene::Tool& tool) {
    const bool has_shapes = !tool.has_mesh_path();
    std::set<int> refinements;
    for (const AccuracySettings& choice : accuracyChoices(scene)) {
        const bool needs_grid = choice.law != ContactLaw::kThesis2012 &&
                                !(has_shapes && choice.tool_distance == ToolDistance::kAnalytic);
        if (needs_grid && choice.sdf_refinement > 1) refinements.insert(choice.sdf_refinement);
    }
    return {refinements.begin(), refinements.end()};
}

double thinnestWall(const scene::Scene& scene, double finest_spacing) {
    const scene::Contact& contact = scene.contact();
    return contact.has_thinnest_wall_mm() ? contact.thinnest_wall_mm() * kMillimetre : finest_spacing;
}

double wallForce(const GradientContactConfig& contact, double radius, double wall) {
    const double depth = std::min(wall / 2, 2 * radius / 3);
    return std::min(M_PI * contact.stiffness_per_area * (radius - depth) * depth * depth,
                    contact.stiffness_cap * depth);
}

constexpr int kSprings = 2;  // the lasting and the relaxing one

double mostCarried(const GradientContactConfig& contact, double radius) {
    return wallForce(contact, radius, 4 * radius);
}

double saturationForceOf(const scene::Scene& scene, const scene::Tool& tool, double finest_spacing) {
    const GradientContactConfig contact = contactConfigOf(scene.contact());
    const double radius = tool.burr_radius_mm() * kMillimetre;
    return std::min({scene.coupling().max_force_n(),
                     wallForce(contact, radius, thinnestWall(scene, finest_spacing)),
                     kOfCarried / kSprings * mostCarried(contact, radius)});
}

GradientConfig gradientConfigOf(const scene::Scene& scene) {
    const scene::Coupling& coupling = scene.coupling();
    GradientConfig config;
    config.max_speed = coupling.max_speed_mm_per_s() * kMillimetre;
    config.max_angular_speed = coupling.max_angular_speed_deg_per_s() * kDegree;
    config.contact = contactConfigOf(scene.contact());
    const double stiffness = coupling.rotation_stiffness_nmm_per_rad() * kMillimetre / 2;
    config.coupling = {.translation_stiffness = coupling.translation_stiffness_n_per_mm() / kMillimetre,
                       .rotation_stiffness = stiffness,
                       .saturation_torque = std::min(coupling.max_torque_nmm() * kMillimetre,
                                                     stiffness * coupling.saturation_angle_deg() * kDegree),
                       .damping_time = coupling.damping_time_ms() * kMillisecond,
                       .relaxing_share = coupling.relaxing_share(),
                       .relaxing_time = coupling.relaxing_time_ms() * kMillisecond,
                       .p_TG = kMillimetre * Eigen::Vector3d(coupling.grip_mm().x(), coupling.grip_mm().y(),
                                                             coupling.grip_mm().z())};
    return config;
}

}  // namespace bonemill
