#include "render_client/look/structures/structure_set.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr float kGamma = 2.2f;  // as toneMap() of the shaders

const Vector3f kNerve(0.95f, 0.85f, 0.20f), kVein(0.10f, 0.45f, 0.85f), kArtery(0.84f, 0.17f, 0.12f),
    kDura(0.82f, 0.64f, 0.96f);
const struct {
    const char* word;
    const Vector3f& colour;
} kCustom[] = {{"nerve", kNerve},   {"chorda", kNerve}, {"sinus", kVein},     {"vein", kVein},
               {"jugular", kVein},  {"arter", kArtery}, {"carotid", kArtery}, {"aorta", kArtery},
               {"vessel", kArtery}, {"pulp", kArtery},  {"dura", kDura},      {"sac", kDura}};
const Vector3f kOthers[] = {{0.90f, 0.62f, 0.00f}, {0.34f, 0.71f, 0.91f}, {0.00f, 0.62f, 0.45f},
                            {0.80f, 0.47f, 0.65f}, {0.84f, 0.37f, 0.00f}, {0.00f, 0.45f, 0.70f}};

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char sign) { return char(std::tolower(sign)); });
    return text;
}

constexpr float kFinest = 4e-4f;  // m
constexpr int kBlock = 4;         // samples: one look says whether any of a block is near

// What lies deep in a structure is far from its surface, and yet not far from the structure.
std::optional<NearestPlace> nearestOf(const TriangleTree& tree, const Eigen::Vector3f& p_V, float within) {
    return tree.nearest(p_V, tree.box().contains(p_V) ? TriangleTree::kAnyDistance : within);
}

}  // namespace

Vector3f structureColour(const topics::SceneInfo& info, uint32_t structure) {
    if (structure > 0 && structure <= uint32_t(info.materials_size())) {
        const scene::Material& material = info.materials(int(structure) - 1);
        const scene::Color& color = material.color();
        if (material.has_color())
            return Eigen::Vector3d(color.red(), color.green(), color.blue()).cast<float>();
        const std::string name = lowered(material.name());
        for (const auto& custom : kCustom)
            if (name.find(custom.word) != std::string::npos) return custom.colour;
    }
    return kOthers[structure % std::size(kOthers)];
}

Vector3f linearColour(const Vector3f& srgb) {
    return srgb.array().max(0.0f).min(1.0f).pow(kGamma);
}

Vector3f srgbColour(const Vector3f& linear) {
    return linear.array().max(0.0f).min(1.0f).pow(1 / kGamma);
}

const std::array<Vector3f, kThicknessColours>& thicknessColours() {
    static const std::array<Vector3f, kThicknessColours> kColours = {
        Vector3f(0.50f, 0.01f, 0.03f), Vector3f(0.85f, 0.20f, 0.02f), Vector3f(0.95f, 0.72f, 0.05f),
        Vector3f(0.42f, 0.80f, 0.62f), Vector3f(0.10f, 0.38f, 0.78f)};
    return kColours;
}

Vector3f distanceColour(double distance, double warning_distance) {
    const auto share = float(std::clamp(distance / warning_distance, 0.0, 1.0));
    const Vector3f red(0.95f, 0.10f, 0.08f), yellow(1.0f, 0.85f, 0.10f), green(0.20f, 0.80f, 0.35f);
    return share < 0.5f ? red + 2 * share * (yellow - red) : yellow + (2 * share - 1) * (green - yellow);
}

ThicknessField thicknessField(const StructureSet& structures, double reach) {
    ThicknessField field;
    const Eigen::AlignedBox3f box = structures.box();
    if (box.isEmpty() || !(reach > 0)) return field;
    field.reach = float(reach);
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(field.reach);
    const Eigen::Vector3f wide = box.sizes() + 2 * margin;
    field.first_V = box.min() - margin;
    field.step = std::max(kFinest, wide.maxCoeff() / float(ThicknessField::kMaxPerAxis - 2));
    const auto sizeOf = [&wide](float step) {
        return Eigen::Vector3i((wide / step).array().ceil().cast<int>().matrix() + Eigen::Vector3i::Ones());
    };
    while (sizeOf(field.step).cast<int64_t>().prod() > ThicknessField::kMaxSamples) field.step *= 1.05f;
    field.size = sizeOf(field.step);
    field.shares.assign(size_t(field.size.prod()), 255);
    const Eigen::Vector3i blocks = (field.size.array() + kBlock - 1) / kBlock;
    const float half = 0.5f * std::sqrt(3.0f) * float(kBlock) * field.step;
    for (int block = 0; block < blocks.prod(); ++block) {
        const Eigen::Vector3i at(block % blocks.x(), block / blocks.x() % blocks.y(),
                                 block / blocks.x() / blocks.y());
        const Eigen::Vector3i low = kBlock * at, high = (low.array() + kBlock).min(field.size.array());
        const Eigen::Vector3f middle =
            field.first_V + field.step * (low.cast<float>() + Eigen::Vector3f::Constant(0.5f * kBlock));
        if (structures.distance(middle, field.reach + half) >= field.reach + half) continue;
        for (int k = low.z(); k < high.z(); ++k)
            for (int j = low.y(); j < high.y(); ++j)
                for (int i = low.x(); i < high.x(); ++i) {
                    const Eigen::Vector3f p =
                        field.first_V + field.step * Eigen::Vector3f(float(i), float(j), float(k));
                    const float share = structures.distance(p, field.reach) / field.reach;
                    field.shares[size_t(i + field.size.x() * (j + field.size.y() * k))] =
                        uint8_t(std::lround(255 * share));
                }
    }
    return field;
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

float StructureSet::distance(const Eigen::Vector3f& p_V, float within) const {
    float least = within;
    for (const auto& [id, structure] : structures_) {
        if (structure.tree.box().squaredExteriorDistance(p_V) >= least * least) continue;
        if (const auto place = nearestOf(structure.tree, p_V, least))
            least = std::min(least, place->distance);
        least = std::max(least, 0.0f);
    }
    return least;
}

}  // namespace bonemill
