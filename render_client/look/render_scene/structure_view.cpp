#include "render_client/look/render_scene/structure_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/structures/structure_colours.h"

namespace bonemill {
namespace {

// What has its own colour is drawn anew for each step of its glow.
constexpr double kGlowSteps = 4;
constexpr double kBesideBone = 1e-4;  // m: a surface that lies in the bone's is not behind it

float glowOf(const Clearance& clearance) {
    const double share = std::clamp(1 - clearance.distance / clearance.warning_distance, 0.0, 1.0);
    return float(std::ceil(kGlowSteps * share) / kGlowSteps);
}

// The part of a ray that cut-planes leave, in its direction's lengths.
std::pair<double, double> shownPart(const CutPlanes& cuts_W, const Eigen::Vector3d& from_W,
                                    const Eigen::Vector3d& direction_W) {
    double first = 0, last = std::numeric_limits<double>::max();
    for (size_t i = 0; i < cuts_W.planes.size(); ++i) {
        if (!cuts_W.is_on[i]) continue;
        const Eigen::Vector4d plane = cuts_W.planes[i].cast<double>();
        const double at = plane.head<3>().dot(from_W) + plane.w(), slope = plane.head<3>().dot(direction_W);
        if (slope > 0) {
            first = std::max(first, -at / slope);
        } else if (slope < 0) {
            last = std::min(last, -at / slope);
        } else if (at < 0) {
            last = 0;
        }
    }
    return {first, last};
}

}  // namespace

void StructureView::setInfo(const topics::SceneInfo& info) {
    *info_.mutable_materials() = info.materials();
    burr_ = burrBallsOf(info);
}

void StructureView::show(const ViewSettings& settings, FrameView& view) const {
    if (structures_.all().empty()) return;
    for (const auto& [id, structure] : structures_.all())
        view.structures.push_back(
            {id, linearColour(structureColour(info_, id)), settings.structures[id % kMaxStructures], 0});
    view.structures_V = structures_.box().cast<double>();
    view.shows_thickness = settings.show_thickness;
    if (!view.X_WT) return;
    const std::vector<Clearance> clearances = structures_.clearances(burr_, view.X_WV.inverse() * *view.X_WT);
    for (const Clearance& near : clearances)
        for (StructureLook& look : view.structures)
            if (look.structure == near.structure) look.glow = glowOf(near);
    if (clearances.empty() || !settings.show_clearance) return;
    const Clearance& nearest = clearances.front();
    view.clearance =
        ClearanceLine{view.X_WV * nearest.burr_V, view.X_WV * nearest.structure_V,
                      distanceColour(nearest.distance, nearest.warning_distance), nearest.distance};
}

std::string StructureView::nameAlong(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W,
                                     double bone_at, const FrameView& view) const {
    const auto [first, last] = shownPart(view.cuts_W, from_W, direction_W);
    const Pose X_VW = view.X_WV.inverse();
    const Eigen::Vector3f from_V = (X_VW * (from_W + first * direction_W)).cast<float>();
    const Eigen::Vector3f direction_V = (X_VW.rotation * direction_W).cast<float>();
    float nearest =
        last - first < TriangleTree::kAnyDistance ? float(last - first) : TriangleTree::kAnyDistance;
    std::string name;
    for (const StructureLook& look : view.structures) {
        if (look.mode == StructureMode::kOff) continue;
        const TriangleTree& tree = structures_.all().at(look.structure).tree;
        const auto hit = tree.firstHit(from_V, direction_V, nearest);
        if (!hit) continue;
        const bool is_behind = (first + *hit) * direction_W.norm() > bone_at + kBesideBone;
        if (is_behind && look.mode == StructureMode::kExposedOnly && !view.bone_opacity) continue;
        nearest = *hit;
        name = structureName(look.structure, &info_);
    }
    return name;
}

HudLegend StructureView::legend() const {
    HudLegend legend{"To the next structure",
                     {},
                     "0 mm",
                     readableText(structures_.largestWarningDistance() * kPerMillimetre, " mm")};
    for (const Eigen::Vector3f& colour : thicknessColours()) {
        const Eigen::Vector3f srgb = srgbColour(colour);
        legend.colours.push_back({srgb.x(), srgb.y(), srgb.z()});
    }
    return legend;
}

}  // namespace bonemill
