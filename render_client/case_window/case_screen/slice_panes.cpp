// The right of the screen: three slices and the bone, what is drawn over them, and what the mouse does there.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/units.h"
#include "common/text/printed_text.h"
#include "render_client/case_window/case_screen/case_screen.h"
#include "render_client/language/language.h"
#include "render_client/look/model/node_store.h"

namespace bonemill {
namespace {

constexpr ImU32 kCrossColour = IM_COL32(110, 190, 255, 120), kRegionColour = IM_COL32(90, 225, 130, 255),
                kFarRegionColour = IM_COL32(90, 225, 130, 90), kHandColour = IM_COL32(255, 95, 140, 255),
                kSideColour = IM_COL32(255, 255, 255, 170);
constexpr float kReach = 10;  // pixels at scale 1 from a handle's middle
constexpr double kMaxZoom = 16, kZoomStep = 1.15, kOrbitStep = 0.008;  // rad per pixel

ImVec2 operator+(const ImVec2& a, const Eigen::Vector2d& b) {
    return {a.x + float(b.x()), a.y + float(b.y())};
}

Eigen::Vector2d mouseFrom(const ImVec2& corner) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {double(mouse.x - corner.x), double(mouse.y - corner.y)};
}

void drawArrow(ImDrawList& draw, const ImVec2& tip, const ImVec2& end, float scale) {
    const Eigen::Vector2f way(tip.x - end.x, tip.y - end.y);
    draw.AddLine(end, tip, kHandColour, 2.5f * scale);
    draw.AddCircleFilled(end, 6 * scale, kHandColour);
    if (way.norm() < 4 * scale) return;
    const Eigen::Vector2f along = way.normalized() * 12 * scale,
                          across(-along.y() * 0.45f, along.x() * 0.45f);
    draw.AddTriangleFilled(tip, ImVec2(tip.x - along.x() + across.x(), tip.y - along.y() + across.y()),
                           ImVec2(tip.x - along.x() - across.x(), tip.y - along.y() - across.y()),
                           kHandColour);
}

}  // namespace

// All of the bone, or of the scan as long as there is none.
void CaseScreen::lookAtAll() {
    if (!desk_.scan()) return;
    Eigen::AlignedBox3d box;
    const Pose& X_WV = desk_.scan()->geometry.X_WV;
    for (const NodeMesh& mesh : desk_.surface())
        for (const PackedVertex& v : mesh.vertices)
            box.extend(X_WV * Eigen::Vector3d(positionOf(mesh, v).cast<double>()));
    if (box.isEmpty()) box = desk_.scanBox();
    std::array<Eigen::Vector3d, 8> corners;
    for (int n = 0; n < 8; ++n) corners[size_t(n)] = box.corner(Eigen::AlignedBox3d::CornerType(n));
    camera_.fit(corners, double(bone_width_) / bone_height_);
}

// A little from the side, so that the arrow does not hide its place (common/geometry/view_axes.h).
void CaseScreen::lookFrom(const Eigen::Vector3d& outwards_W) {
    constexpr double kAside = 0.6, kAbove = 0.25, kMostElevation = 1.4;  // rad
    camera_.azimuth = std::atan2(outwards_W.x(), -outwards_W.y()) - kAside;
    camera_.elevation = std::clamp(std::asin(outwards_W.z()) + kAbove, -kMostElevation, kMostElevation);
}

// Another scan is looked at anew, and once more when its bone is there.
void CaseScreen::lookAtNew() {
    const bool is_new = desk_.scan() != seen_scan_, has_bone = !desk_.surface().empty();
    if (is_new) {
        zoom_ = 1;
        grip_.reset();
        camera_ = OrbitCamera();
    }
    if (has_bone && !seen_bone_ && desk_.isOfPart() && desk_.plan()) lookFrom(desk_.plan()->outwards);
    if (is_new || (has_bone && !seen_bone_)) lookAtAll();
    seen_scan_ = desk_.scan();
    seen_bone_ = has_bone;
}

void CaseScreen::buildPanes(const ImVec2& size) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 pane(std::max(std::floor((size.x - gap) / 2), 32.f),
                      std::max(std::floor((size.y - gap) / 2), 32.f));
    if (!desk_.scan()) {
        ImGui::BeginChild("empty", size, true);
        const char* const hint = desk_.busyWith().empty()
                                     ? tr("Drop the folder of a scan here, or open one at the left.")
                                     : tr("One moment ...");
        const ImVec2 text = ImGui::CalcTextSize(hint);
        ImGui::SetCursorPos(ImVec2((size.x - text.x) / 2, (size.y - text.y) / 2));
        ImGui::TextDisabled("%s", hint);
        ImGui::EndChild();
        return;
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(gap, gap));
    buildSlice(2, pane);
    ImGui::SameLine();
    buildSlice(1, pane);
    buildSlice(0, pane);
    ImGui::SameLine();
    buildBoneView(pane);
    ImGui::PopStyleVar();
}

void CaseScreen::buildSlice(size_t axis, const ImVec2& size) {
    Eigen::Vector3d middle_W = zoom_middle_W_;
    middle_W[Eigen::Index(axis)] = desk_.marks().cross_W[Eigen::Index(axis)];
    panes_[axis] = paneOver(desk_.scanBox(), axis, int(size.x), int(size.y), zoom_, middle_W);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(int(axis));
    ImGui::InvisibleButton("slice", size);
    notePlace(places_, sliceLabelsOf(axis, true).title);
    ImGui::PopID();
    moveOnSlice(axis, corner);
    if (ImGui::IsItemHovered()) scrollSlice(axis, corner);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    draw.AddImage(reinterpret_cast<ImTextureID>(intptr_t(kSlicePictures[axis])), corner, end);
    draw.PushClipRect(corner, end, true);
    drawMarks(panes_[axis], corner);
    drawSides(panes_[axis], corner);
    draw.PopClipRect();
}

void CaseScreen::moveOnSlice(size_t axis, const ImVec2& corner) {
    const Eigen::Vector2d pixel = mouseFrom(corner);
    const ScanPane& pane = panes_[axis];
    const double reach = double(kReach * stage_.scale());
    if (ImGui::IsItemActivated()) grip_ = gripAt(pane, desk_.marks(), pixel, reach);
    if (ImGui::IsItemActive() && grip_) desk_.drag(*grip_, pane, pixel);
    if (ImGui::IsItemDeactivated()) grip_.reset();
    if (ImGui::IsItemHovered() && gripAt(pane, desk_.marks(), pixel, reach) != Grip::kCross)
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
}

void CaseScreen::scrollSlice(size_t axis, const ImVec2& corner) {
    const float steps = ImGui::GetIO().MouseWheel;
    if (steps == 0) return;
    const Eigen::Index along = Eigen::Index(axis);
    if (!ImGui::GetIO().KeyCtrl) {
        const VolumeGeometry& geometry = desk_.scan()->geometry;
        Eigen::Vector3d cross_W = desk_.marks().cross_W;
        cross_W[along] += double(steps) * sliceStep(gridOf(geometry), geometry.X_WV, axis);
        return desk_.moveCross(cross_W);
    }
    const ScanPane& pane = panes_[axis];
    const Eigen::Vector3d under_W = pane.toWorld(mouseFrom(corner));
    const double zoom = std::clamp(zoom_ * std::pow(kZoomStep, double(steps)), 1.0, kMaxZoom);
    if (zoom_ <= 1) zoom_middle_W_ = desk_.marks().cross_W;
    const Eigen::Vector3d middle_W = under_W + (pane.middle_W - under_W) * (zoom_ / zoom);
    for (Eigen::Index i = 0; i < 3; ++i)
        if (i != along) zoom_middle_W_[i] = middle_W[i];
    zoom_ = zoom;
}

void CaseScreen::drawMarks(const ScanPane& pane, const ImVec2& corner) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float scale = stage_.scale();
    const CaseMarks marks = desk_.marks();
    const ImVec2 cross = corner + pane.toPixel(marks.cross_W);
    draw.AddLine(ImVec2(cross.x, corner.y), ImVec2(cross.x, corner.y + float(pane.height)), kCrossColour);
    draw.AddLine(ImVec2(corner.x, cross.y), ImVec2(corner.x + float(pane.width), cross.y), kCrossColour);
    if (marks.region_W) {
        const Eigen::Index along = Eigen::Index(pane.axis);
        const double at = pane.middle_W[along];
        const bool is_cut = at >= marks.region_W->min()[along] && at <= marks.region_W->max()[along];
        const ImVec2 a = corner + pane.toPixel(marks.region_W->min()),
                     b = corner + pane.toPixel(marks.region_W->max());
        const ImU32 colour = is_cut ? kRegionColour : kFarRegionColour;
        draw.AddRect(ImVec2(std::min(a.x, b.x), std::min(a.y, b.y)),
                     ImVec2(std::max(a.x, b.x), std::max(a.y, b.y)), colour, 0, 0, 1.6f * scale);
        const ImVec2 middle = corner + pane.toPixel(marks.region_W->center());
        draw.AddCircle(middle, 7 * scale, colour, 0, 2 * scale);
        draw.AddCircleFilled(middle, 2 * scale, colour);
    }
    if (marks.start_W && marks.hand_W)
        drawArrow(draw, corner + pane.toPixel(*marks.start_W),
                  corner + handleOf(pane, *marks.start_W, *marks.hand_W), scale);
}

void CaseScreen::drawSides(const ScanPane& pane, const ImVec2& corner) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const SliceLabels& labels = sliceLabelsOf(pane.axis, !desk_.scan()->lacks_patient_axes);
    const float line = ImGui::GetTextLineHeight(), gap = 0.4f * line;
    const float width = float(pane.width), height = float(pane.height);
    const auto text = [&](float x, float y, const char* words) {
        draw.AddText(ImVec2(corner.x + x, corner.y + y), kSideColour, words);
    };
    const std::string title = printed("%s  %c = %.1f mm", tr(labels.title), "xyz"[pane.axis],
                                      pane.middle_W[Eigen::Index(pane.axis)] * kPerMillimetre);
    text(gap, gap, title.c_str());
    text(gap, (height - line) / 2, labels.left);
    text(width - ImGui::CalcTextSize(labels.right).x - gap, (height - line) / 2, labels.right);
    text((width - ImGui::CalcTextSize(labels.top).x) / 2, gap, labels.top);
    text((width - ImGui::CalcTextSize(labels.bottom).x) / 2, height - line - gap, labels.bottom);
}

void CaseScreen::buildBoneView(const ImVec2& size) {
    bone_width_ = int(size.x);
    bone_height_ = int(size.y);
    const ImVec2 corner = ImGui::GetCursorScreenPos(), end(corner.x + size.x, corner.y + size.y);
    ImGui::InvisibleButton("bone", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    notePlace(places_, "bone");
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left))
        camera_.orbit(-double(io.MouseDelta.x) * kOrbitStep, double(io.MouseDelta.y) * kOrbitStep);
    if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right))
        camera_.pan(double(io.MouseDelta.x / size.y), -double(io.MouseDelta.y / size.y));
    if (ImGui::IsItemHovered() && io.MouseWheel != 0)
        camera_.zoom(std::pow(kZoomStep, -double(io.MouseWheel)));
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) lookAtAll();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddImage(reinterpret_cast<ImTextureID>(intptr_t(kBonePicture)), corner, end, ImVec2(0, 1),
                  ImVec2(1, 0));
    const float gap = 0.4f * ImGui::GetTextLineHeight();
    const char* const text = desk_.isBoneOfNow() ? tr("Bone") : desk_.bone() ? tr("Bone, as it was") : "";
    draw.AddText(ImVec2(corner.x + gap, corner.y + gap), kSideColour, text);
}

}  // namespace bonemill
