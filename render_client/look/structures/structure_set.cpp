#include "render_client/look/structures/structure_set.h"

#include <algorithm>

namespace bonemill {
namespace {

// What lies deep in a structure is far from its surface, and yet not far from the structure.
std::optional<NearestPlace> nearestOf(const TriangleTree& tree, const Eigen::Vector3f& p_V, float within) {
    return tree.nearest(p_V, tree.box().contains(p_V) ? TriangleTree::kAnyDistance : within);
}

}  // namespace

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
