#include "render_client/look/render_scene/bone_marks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "common/base/units.h"
#include "common/dds/remark_bounds.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/structures/structure_set.h"

namespace bonemill {
namespace {

constexpr size_t kLongestLabel = 40;  // bytes
constexpr uint32_t kNoteColour = 0xf2f2f2;

std::string labelOf(const topics::Remark& note) {
    const std::string start = cutToBytes(note.note(), kLongestLabel);
    return start.size() < note.note().size() ? start + "\u2026" : start;
}

constexpr int kLooks = 8;            // pixels around the burr that are looked at
constexpr double kBesideBurr = 1.7;  // burr radii from its middle, where it hides nothing
constexpr double kMinGap = 0.2;      // burr radii: less is hardly in front
constexpr double kMaxGap = 40;       // burr radii: more is another part of the bone

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

Eigen::Vector3f strokeColour(uint32_t colour) {
    const auto part = [colour](int shift) { return float(colour >> shift & 0xff) / 255; };
    return linearColour({part(16), part(8), part(0)});
}

void RemarkView::set(const std::map<uint32_t, topics::Remark>& remarks) {
    strokes_.clear();
    labels_.clear();
    std::vector<const topics::Remark*> newest_first;
    for (const auto& [place, remark] : remarks)
        if (remark.points_m_size() >= 3) newest_first.push_back(&remark);
    std::ranges::sort(newest_first, std::greater{}, [](const topics::Remark* r) { return r->number(); });
    for (const topics::Remark* const remark : newest_first) {
        Stroke& stroke = strokes_.emplace_back();
        stroke.colour = strokeColour(remark->note().empty() ? remark->color() : kNoteColour);
        for (int n = 0; n + 2 < remark->points_m_size(); n += 3)
            stroke.points_W.emplace_back(remark->points_m(n), remark->points_m(n + 1),
                                         remark->points_m(n + 2));
        if (!remark->note().empty() && labels_.size() < kMaxLabels)
            labels_.push_back({stroke.points_W[0].cast<double>(), labelOf(*remark)});
    }
    std::ranges::reverse(strokes_);  // newer ones lie over older ones
}

// The shaft hides some of the surroundings, and walls stand beside the burr: the middle one of all gaps
// counts.
std::optional<double> burrGap(const FrameView& view, const Eigen::Vector2i& size,
                              const std::function<std::optional<Eigen::Vector3d>(int, int)>& pick) {
    if (!view.X_WT || !(view.burr_radius > 0)) return std::nullopt;
    const Camera& camera = view.camera;
    const Eigen::Vector3d burr_C = camera.R_WC.transpose() * (view.X_WT->position - camera.eye_W);
    const double depth = -burr_C.z();
    if (!(depth > view.burr_radius)) return std::nullopt;
    const double pixels = size.y() / (2 * camera.halfTangent() * depth);
    const Eigen::Vector2d middle(size.x() / 2.0 + burr_C.x() * pixels, size.y() / 2.0 - burr_C.y() * pixels);
    double gaps[kLooks];
    int found = 0;
    for (int i = 0; i < kLooks; ++i) {
        const double angle = 2 * M_PI * (i + 0.5) / kLooks;
        const Eigen::Vector2d at = middle + kBesideBurr * view.burr_radius * pixels *
                                                Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const auto seen_W = pick(int(at.x()), int(at.y()));
        if (seen_W) gaps[found++] = (*seen_W - camera.eye_W).dot(camera.forward_W()) - depth;
    }
    if (found <= kLooks / 2) return std::nullopt;
    std::sort(gaps, gaps + found);
    const double gap = gaps[found / 2] - view.burr_radius;
    if (gap < kMinGap * view.burr_radius || gap > kMaxGap * view.burr_radius) return std::nullopt;
    return gap;
}

BurrGap behindBurr(const FrameView& view, double distance) {
    const Eigen::Vector3d sight_W = view.X_WT->position - view.camera.eye_W;
    const double way = (view.burr_radius + distance) / sight_W.dot(view.camera.forward_W());
    return {view.X_WT->position + way * sight_W, distance};
}

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
    HudLegend legend{tr("To the next structure"),
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
