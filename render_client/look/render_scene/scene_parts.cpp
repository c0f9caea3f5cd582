// The parts of RenderScene that write names, figures and notes beside what they belong to, and that draw a
// picture for each eye, or for each of two attempts.
#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/render_scene/render_scene.h"
#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {

std::optional<Eigen::Vector3d> pointerPlace(const topics::Viewer& watcher) {
    if (watcher.role() != topics::Viewer::INSTRUCTOR) return std::nullopt;
    return readVector(watcher.pointer_m());
}

std::string RenderScene::structureAt(int x, int y) const {
    const auto size = renderer_.pictureSize();
    if (!can_pick_ || last_view_.structures.empty() || x < 0 || y < 0 || x >= size.x() || y >= size.y())
        return "";
    const Camera& camera = last_view_.camera;
    const auto bone_W = renderer_.pick(x, y);
    const double bone_at = bone_W ? (*bone_W - camera.eye_W).norm() : std::numeric_limits<double>::max();
    return structures_.nameAlong(camera.eye_W, camera.rayThrough(x, y, size.x(), size.y()), bone_at,
                                 last_view_);
}

void RenderScene::nameMouse(const PictureArea& area, std::vector<HudLabel>& labels) const {
    if (!mouse_ || !can_pick_ || area.x != 0) return;
    const std::string name = structureAt(mouse_->first, mouse_->second);
    if (!name.empty()) labels.push_back({float(mouse_->first), float(mouse_->second), name});
}

void RenderScene::paintNames(const FrameView& view, const PictureArea& area, float ui_scale) {
    std::vector<HudLabel> labels;
    const auto add = [&](const Eigen::Vector3d& p_W, const std::string& text, bool is_of_pointer) {
        const Eigen::Vector3d p_C = view.camera.R_WC.transpose() * (p_W - view.camera.eye_W);
        if (p_C.z() >= 0 || text.empty()) return;
        const double pixels = area.height / (2 * view.camera.halfTangent() * -p_C.z());
        const double right = area.width / 2.0 + (p_C.x() + view.camera.shift * p_C.z()) * pixels;
        labels.push_back({float(right), float(area.height / 2.0 - p_C.y() * pixels), text, is_of_pointer});
    };
    for (const topics::Viewer& watcher : hud_input_.watchers) {
        const auto pointer = pointerPlace(watcher);
        if (!pointer) continue;
        const Eigen::Vector3d way = *pointer - view.camera.eye_W;
        const std::string structure = structures_.nameAlong(view.camera.eye_W, way, way.norm(), view);
        add(*pointer, watcher.name() + (watcher.name().empty() || structure.empty() ? "" : ": ") + structure,
            true);
    }
    if (view.clearance && settings_.show_hud)
        add((view.clearance->burr_W + view.clearance->structure_W) / 2,
            readableText(std::max(view.clearance->distance, 0.0) * kPerMillimetre, " mm"), false);
    if (view.gap && settings_.show_hud)
        add(view.gap->surface_W + gapRingRadius(view) * view.camera.R_WC.col(0),
            tr("{1} to the bone", {readableText(view.gap->distance * kPerMillimetre, " mm")}), false);
    if (settings_.show_remarks)
        for (const RemarkView::Label& label : remarks_.labels()) add(label.p_W, label.text, false);
    nameMouse(area, labels);
    if (!labels.empty()) hud_painter_.paintLabels(labels, {area.width, area.height}, ui_scale);
}

void RenderScene::drawSideBySide(const FrameView& view, int width, int height, float ui_scale,
                                 GLuint target) {
    const StereoPair eyes = stereoPair(view.camera);
    const int half = width / 2;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);  // the last column of an odd width belongs to neither eye
    for (const auto& [camera, x] : {std::pair{eyes.left, 0}, std::pair{eyes.right, half}}) {
        const PictureArea area{x, half, height};
        drawEye(view, camera, area, ui_scale, target);
        paintHud(camera, area, ui_scale);
    }
    gl_.Viewport(0, 0, width, height);
}

bool RenderScene::showsBeside() const {
    const auto& status = hud_input_.status;
    return settings_.stereo == StereoMode::kOff && other_nodes_.nodeCount() > 0 && status &&
           status->replay().comparison().shows_beside();
}

bool RenderScene::isOfOther(uint32_t leaf) const {
    const uint32_t first = !awaits_info_ && hud_input_.info ? hud_input_.info->other_first_leaf() : 0;
    return first > 0 && leaf >= first;
}

// From the same place, or on the other tool; what is told of the hand and its effects is the first one's.
FrameView RenderScene::otherView(FrameView view) {
    view.X_WT = std::exchange(view.X_WT_expert, {});
    view.X_WT_device.reset();
    view.f_T_W.reset();
    view.pull.reset();
    view.gap.reset();
    view.clearance.reset();
    view.burr_work = BurrWork::kIdle;
    view.burr_load = 0;
    if (view.effects) {
        no_effects_.film = view.effects->film;
        view.effects = &no_effects_;
    }
    if (followsTool() && view.X_WT) view.camera = endoscopeCamera(*view.X_WT, view.burr_radius);
    return view;
}

// The renderer keeps the picture that was drawn last: the first bone's, in which one can pick.
void RenderScene::drawBeside(const FrameView& view, int width, int height, float ui_scale, GLuint target) {
    const int half = width / 2;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);  // the last column of an odd width belongs to neither
    const PictureArea right{half, half, height};
    renderer_.drawWholeNext();
    renderer_.draw(otherView(view), other_nodes_, tool_, right, target);
    const std::string& whose = hud_input_.status->replay().comparison().attempt();
    constexpr float kFromAbove = 24;  // pixels at scale 1
    hud_painter_.paintLabels({{float(half) / 2, kFromAbove * ui_scale, whose}}, {half, height}, ui_scale);
    renderer_.drawWholeNext();
    drawEye(view, view.camera, {0, half, height}, ui_scale, target);
    gl_.Viewport(0, 0, width, height);
    paintHud(view.camera, {0, width, height}, ui_scale);
}

void RenderScene::drawAnaglyph(const FrameView& view, int width, int height, float ui_scale, GLuint target) {
    const StereoPair eyes = stereoPair(view.camera);
    const PictureArea whole{0, width, height};
    anaglyph_.resize(width, height);
    drawEye(view, eyes.left, whole, ui_scale, anaglyph_.left());
    drawEye(view, eyes.right, whole, ui_scale, anaglyph_.right());
    anaglyph_.combine(target);
    paintHud(view.camera, whole, ui_scale);
}

}  // namespace bonemill
