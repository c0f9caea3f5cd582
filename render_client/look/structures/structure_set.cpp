#include "render_client/look/structures/structure_set.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>

#include "render_client/look/hud/palette.h"

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr float kGamma = 2.2f;  // as toneMap() of the shaders

enum Named { kNerve, kVein, kArtery, kDura };  // places of Palette::named
constexpr struct {
    const char* word;
    Named named;
} kCustom[] = {{"nerve", kNerve},   {"chorda", kNerve}, {"sinus", kVein},     {"vein", kVein},
               {"jugular", kVein},  {"arter", kArtery}, {"carotid", kArtery}, {"aorta", kArtery},
               {"vessel", kArtery}, {"pulp", kArtery},  {"dura", kDura},      {"sac", kDura}};

Vector3f vectorOf(const Srgb& colour) {
    return {float(colour[0]), float(colour[1]), float(colour[2])};
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char sign) { return char(std::tolower(sign)); });
    return text;
}

}  // namespace

Vector3f structureColour(const topics::SceneInfo& info, uint32_t structure) {
    if (structure > 0 && structure <= uint32_t(info.materials_size())) {
        const scene::Material& material = info.materials(int(structure) - 1);
        const scene::Color color = shownColour(material.color());
        if (material.has_color())
            return Eigen::Vector3d(color.red(), color.green(), color.blue()).cast<float>();
        const std::string name = lowered(material.name());
        for (const auto& custom : kCustom)
            if (name.find(custom.word) != std::string::npos) return vectorOf(palette().named[custom.named]);
    }
    const auto& others = palette().structures;
    return vectorOf(others[structure % others.size()]);
}

Vector3f linearColour(const Vector3f& srgb) {
    return srgb.array().max(0.0f).min(1.0f).pow(kGamma);
}

Vector3f srgbColour(const Vector3f& linear) {
    return linear.array().max(0.0f).min(1.0f).pow(1 / kGamma);
}

Vector3f distanceColour(double distance, double warning_distance) {
    const auto share = float(std::clamp(distance / warning_distance, 0.0, 1.0));
    const auto& colours = palette().distance;
    const Vector3f near = vectorOf(colours[0]), half = vectorOf(colours[1]), far = vectorOf(colours[2]);
    return share < 0.5f ? near + 2 * share * (half - near) : half + (2 * share - 1) * (far - half);
}

std::vector<BurrBall> burrBallsOf(const topics::SceneInfo& info) {
    const auto& numbers = info.burr_balls_m();
    std::vector<BurrBall> balls;
    for (int i = 0; i + 3 < numbers.size(); i += 4)
        balls.push_back({{numbers[i], numbers[i + 1], numbers[i + 2]}, numbers[i + 3]});
    if (balls.empty()) balls.push_back({Eigen::Vector3d::Zero(), info.burr_radius_m()});
    return balls;
}

void StructureSet::set(const NodeMesh& mesh, double warning_distance) {
    structures_.insert_or_assign(mesh.leaf, Structure{TriangleTree(mesh), warning_distance});
}

Eigen::AlignedBox3f StructureSet::box() const {
    Eigen::AlignedBox3f box;
    for (const auto& [id, structure] : structures_) box.extend(structure.tree.box());
    return box;
}

double StructureSet::largestWarningDistance() const {
    double largest = 0;
    for (const auto& [id, structure] : structures_) largest = std::max(largest, structure.warning_distance);
    return largest;
}

std::vector<Clearance> StructureSet::clearances(std::span<const BurrBall> burr, const Pose& X_VT) const {
    std::vector<Clearance> clearances;
    for (const auto& [id, structure] : structures_) {
        Clearance least{.structure = id,
                        .distance = structure.warning_distance,
                        .warning_distance = structure.warning_distance};
        for (const BurrBall& ball : burr) {
            const Eigen::Vector3d center_V = X_VT * ball.center_T;
            const double within = std::max(least.distance, 0.0) + ball.radius;
            const auto place = nearestOf(structure.tree, center_V.cast<float>(), float(within));
            if (!place || place->distance - ball.radius >= least.distance) continue;
            least.structure_V = place->p_V.cast<double>();
            least.distance = place->distance - ball.radius;
            const Eigen::Vector3d way = (place->distance < 0 ? -1 : 1) * (least.structure_V - center_V);
            least.burr_V = center_V + ball.radius * way.normalized();
        }
        if (least.distance < least.warning_distance) clearances.push_back(least);
    }
    std::ranges::sort(clearances, {}, &Clearance::distance);
    return clearances;
}

}  // namespace bonemill
