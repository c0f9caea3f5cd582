#include "render_client/scene/render_scene.h"

#include <array>
#include <stdexcept>

#include "render_client/scene/wire_pose.h"

namespace bonemill {

RenderScene::RenderScene(const GlApi& gl) : nodes_(gl), tool_(gl), renderer_(gl), hud_painter_(gl), gl_(gl) {}

void RenderScene::setSceneInfo(const topics::SceneInfo& info) {
    const auto X_WV = readPose(info.p_wv_m(), info.q_wv());
    const auto low = readVector(info.bone_min_m());
    const auto high = readVector(info.bone_max_m());
    if (!X_WV || !low || !high) throw std::invalid_argument("scene info without a pose or a box of the bone");
    tool_.set(info.tool());
    X_WV_ = *X_WV;
    bone_V_ = Eigen::AlignedBox3d(*low, *high);
    if (!hud_input_.info || hud_input_.info->name() != info.name()) view_pending_ = true;
    hud_input_.info = info;
}

void RenderScene::setViewOverrides(const ViewOverrides& overrides) {
    overrides_ = overrides;
    view_pending_ = true;
}

void RenderScene::applyFirstView(double aspect) {
    camera_ = OrbitCamera();
    topics::Camera wish;
    if (hud_input_.info && hud_input_.info->has_camera()) {
        wish = hud_input_.info->camera();
        camera_.azimuth = wish.azimuth_rad();
        camera_.elevation = wish.elevation_rad();
        if (const auto up = readVector(wish.up())) camera_.setUp(*up);
    }
    camera_.azimuth = overrides_.azimuth.value_or(camera_.azimuth);
    camera_.elevation = overrides_.elevation.value_or(camera_.elevation);
    camera_.orbit(0, 0);  // into range

    if (!bone_V_.isEmpty()) {
        std::array<Eigen::Vector3d, 8> corners_W;
        for (int i = 0; i < 8; ++i)
            corners_W[size_t(i)] = X_WV_ * bone_V_.corner(Eigen::AlignedBox3d::CornerType(i));
        camera_.fit(corners_W, aspect);
    }
    const auto wished_target = readVector(wish.target_m());
    if (wish.has_target() && wished_target) camera_.target = *wished_target;
    if (wish.distance_m() > 0) camera_.distance = wish.distance_m();
    camera_.target = overrides_.target.value_or(camera_.target);
    camera_.distance = overrides_.distance.value_or(camera_.distance);
    camera_.zoom(1);  // into range
    view_pending_ = false;
}

FrameView RenderScene::makeView() const {
    FrameView view;
    view.camera = camera_;
    view.X_WV = X_WV_;
    view.bone_V = bone_V_;
    if (hud_input_.info) view.burr_radius = hud_input_.info->burr_radius_m();
    if (hud_input_.tool) {
        const topics::ToolState& tool = *hud_input_.tool;
        view.X_WT = readPose(tool.p_wt_m(), tool.q_wt());
        view.X_WT_device = readPose(tool.p_wt_device_m(), tool.q_wt_device());
        view.burr_work = tool.buttons() & 1u   ? BurrWork::kRemoving
                         : tool.buttons() & 2u ? BurrWork::kAdding
                                               : BurrWork::kIdle;
    }
    return view;
}

void RenderScene::draw(int width, int height, float ui_scale, GLuint target) {
    if (view_pending_) applyFirstView(double(width) / height);
    renderer_.draw(makeView(), nodes_, tool_, width, height, target);
    if (!settings_.show_hud) return;
    hud_input_.node_count = nodes_.nodeCount();
    const double metres_per_pixel = camera_.metresPerPixel(height);
    const ScaleBar bar = hasSceneInfo() ? makeScaleBar(metres_per_pixel, 0.2 * width) : ScaleBar{};
    hud_painter_.paint(makeHud(hud_input_), bar, metres_per_pixel, settings_.show_help, width, height,
                       ui_scale);
    gl_.check("drawing the head-up display");
}

}  // namespace bonemill
