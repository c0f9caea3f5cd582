#include "render_client/look/render_scene/render_scene.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "common/base/units.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/palette.h"
#include "render_client/look/render_scene/bone_marks.h"
#include "render_client/look/visual_effects/effect_input.h"

namespace bonemill {
namespace {

// An empty box has no corners.
std::vector<Eigen::Vector3d> cornersIn(const Pose& X_WV, const Eigen::AlignedBox3d& box_V) {
    std::vector<Eigen::Vector3d> corners_W;
    for (int i = 0; i < 8 && !box_V.isEmpty(); ++i)
        corners_W.push_back(X_WV * box_V.corner(Eigen::AlignedBox3d::CornerType(i)));
    return corners_W;
}

Eigen::AlignedBox3d boxIn(const Pose& X_WV, const Eigen::AlignedBox3d& box_V) {
    Eigen::AlignedBox3d box_W;
    for (const Eigen::Vector3d& corner : cornersIn(X_WV, box_V)) box_W.extend(corner);
    return box_W;
}

ViewWish wishOf(const topics::Camera& camera) {
    ViewWish wish;
    if (camera.has_target()) wish.target_W = readVector(camera.target_m());
    if (camera.distance_m() > 0) wish.distance = camera.distance_m();
    wish.azimuth = camera.azimuth_rad();
    wish.elevation = camera.elevation_rad();
    return wish;
}

}  // namespace

RenderScene::RenderScene(const GlApi& gl, bool has_effects)
    : has_effects_(has_effects),
      nodes_(gl),
      other_nodes_(gl),
      tool_(gl),
      renderer_(gl),
      anaglyph_(gl),
      hud_painter_(gl),
      ct_(gl),
      gl_(gl) {}

void RenderScene::setSceneInfo(const topics::SceneInfo& info) {
    const auto& old = hud_input_.info;
    if (old && old->epoch() == info.epoch() && old->revision() > info.revision()) return;
    const auto X_WV = readPose(info.p_wv_m(), info.q_wv());
    const auto low = readVector(info.bone_min_m());
    const auto high = readVector(info.bone_max_m());
    if (!X_WV || !low || !high) throw std::invalid_argument("scene info without a pose or a box of the bone");
    tool_.set(info.tool(), info.handpiece());
    X_WV_ = *X_WV;
    bone_V_ = Eigen::AlignedBox3d(*low, *high);
    if (!old || old->name() != info.name()) view_pending_ = true;
    if (old && old->name() != info.name()) settings_.forgetScene();
    hud_input_.info = info;
    structures_.setInfo(info);
    awaits_info_ = false;
    if (info.other_first_leaf() > 0) nodes_.giveFrom(info.other_first_leaf(), other_nodes_);
    colourBone();
    makeEffects(info);
}

void RenderScene::colourBone() {
    if (!hud_input_.info) return;
    std::vector<Eigen::Vector4f> colours = vertexColoursOf(*hud_input_.info);
    if (colours != vertex_colours_) {
        renderer_.setPalette(colours);
        ct_.setPalette(paletteOf(*hud_input_.info));
    }
    vertex_colours_ = std::move(colours);
}

// The effects of the same scene go on, also with another tool.
void RenderScene::makeEffects(const topics::SceneInfo& info) {
    const scene::Effects& wish = info.viewer_effects();
    const std::string text = std::to_string(info.epoch()) + wish.SerializeAsString();
    if (!has_effects_ || text == effects_text_) return early_nodes_.clear();
    effects_text_ = text;
    effects_.reset();
    if (VisualEffects::anyIn(wish))
        effects_ = std::make_unique<VisualEffects>(wish, info.burr_radius_m(), info.materials());
    renderer_.prepare({VisualEffects::needsFilm(wish), wish.has_bone_dust() || wish.has_irrigation(),
                       wish.has_burr_spin()});
    effect_picture_ = {};
    for (const auto& [leaf, mesh] : std::exchange(early_nodes_, {}))
        if (effects_ && !isOfOther(leaf)) effects_->setNode(mesh);
    takeEffectInput();
}

void RenderScene::setNode(const NodeMesh& mesh) {
    if (isOfOther(mesh.leaf)) return other_nodes_.set(mesh);
    nodes_.set(mesh);  // throws when it contradicts itself: then no other part gets it
    if (effects_) effects_->setNode(mesh);
    if (has_effects_ && awaits_info_) early_nodes_.insert_or_assign(mesh.leaf, mesh);
}

void RenderScene::setStructure(const NodeMesh& mesh, double warning_distance) {
    renderer_.setStructure(mesh);
    structures_.set(mesh, warning_distance);
    near_structures_.reset();
}

void RenderScene::setRemarks(const std::map<uint32_t, topics::Remark>& remarks) {
    remarks_.set(remarks);
    renderer_.setStrokes(remarks_.strokes());
}

void RenderScene::clearStructures() {
    renderer_.clearStructures();
    structures_.clear();
    near_structures_.reset();
}

// Another run of the server has begun, of which nothing is known yet.
void RenderScene::clearNodes() {
    if (effects_) effects_->clear();
    early_nodes_.clear();
    awaits_info_ = true;
    nodes_.clear();
    other_nodes_.clear();
    hud_input_.tool.reset();
    hud_input_.status.reset();
    faults_.clear();
}

void RenderScene::setToolState(const topics::ToolState& tool) {
    const auto& old = hud_input_.tool;
    const bool is_new = !old || old->epoch() != tool.epoch() || old->tick() != tool.tick();
    if (is_new && tool.has_effects()) {
        events_.note(tool.effects().events());
        if (tool.effects().event_id() != 0) hud_input_.structure = tool.effects().event_id();
    }
    hud_input_.tool = tool;
    takeEffectInput();
}

// Another run of the server has faults of its own.
void RenderScene::setStatus(const topics::Status& status) {
    const auto& old = hud_input_.status;
    if (old && old->epoch() != status.epoch())
        faults_.clear();
    else if (old && effects_ && old->bone_restores() != status.bone_restores())
        effects_->forget();
    hud_input_.status = status;
}

void RenderScene::lookForFaults() {
    const FaultList::Clock::time_point now = FaultList::Clock::now();
    const double session_s = hud_input_.status ? hud_input_.status->session_s() : 0;
    faults_.observe(conditionsOf(hud_input_), session_s, now);
    hud_input_.messages = faults_.said(now);
    hud_input_.fault_count = faults_.faults().size();
}

void RenderScene::takeEffectInput() {
    if (!effects_ || !hud_input_.tool) return;
    const std::pair<uint64_t, uint64_t> state(hud_input_.tool->epoch(), hud_input_.tool->tick());
    if (std::exchange(taken_state_, state) == state) return;
    effects_->take(effectInputOf(*hud_input_.tool, *hud_input_.info));
}

const EffectPicture* RenderScene::effectPicture() {
    if (!effects_) return nullptr;
    EffectPicture& picture = effect_picture_;
    picture.particles.clear();
    const auto shows = [&](ViewerEffect effect) { return settings_.shows(effect); };
    if (effects_->dust() && shows(ViewerEffect::kBoneDust)) effects_->dust()->appendTo(picture.particles);
    if (effects_->irrigation() && shows(ViewerEffect::kIrrigation))
        effects_->irrigation()->appendTo(picture.particles);
    picture.turn.reset();
    if (effects_->spin() && shows(ViewerEffect::kBurrSpin)) picture.turn = effects_->spin()->takeTurn();
    picture.film = effects_->film();
    picture.shows_blood = effects_->bleeding() && shows(ViewerEffect::kBleeding);
    picture.shows_water = effects_->irrigation() && shows(ViewerEffect::kIrrigation);
    picture.shows_burns = effects_->hasBrowning() && shows(ViewerEffect::kBrowning);
    picture.shows_bruises = effects_->hasBruising() && shows(ViewerEffect::kBruising);
    if (effects_->bleeding()) picture.blood_colour = effects_->bleeding()->colour();
    return &picture;
}

void RenderScene::setViewWish(const ViewWish& wish) {
    view_wish_ = wish;
    view_pending_ = true;
}

void RenderScene::applyFirstView(double aspect) {
    ViewWish scene_wish;
    Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
    if (hud_input_.info && hud_input_.info->has_camera()) {
        const topics::Camera& camera = hud_input_.info->camera();
        scene_wish = wishOf(camera);
        up_W = readVector(camera.up()).value_or(up_W);
    }
    camera_ = firstView(view_wish_.orElse(scene_wish), up_W, cornersIn(X_WV_, bone_V_), aspect);
    view_pending_ = false;
}

Eigen::AlignedBox3d RenderScene::bone_W() const {
    return boxIn(X_WV_, bone_V_);
}

std::optional<Pose> RenderScene::toolPose() const {
    if (!hud_input_.tool) return std::nullopt;
    return readPose(hud_input_.tool->p_wt_m(), hud_input_.tool->q_wt());
}

std::optional<Pose> RenderScene::devicePose() const {
    if (!hud_input_.tool) return std::nullopt;
    return readPose(hud_input_.tool->p_wt_device_m(), hud_input_.tool->q_wt_device());
}

bool RenderScene::followsTool() const {
    return settings_.camera == CameraMode::kEndoscope && !tool_.isEmpty() && toolPose();
}

FrameView RenderScene::makeView() const {
    FrameView view;
    view.camera = camera_.view();
    view.X_WV = X_WV_;
    view.bone_V = bone_V_;
    view.quality = settings_.quality;
    view.cuts_W = cutPlanes(settings_.cuts, bone_W());
    if (settings_.is_transparent) view.bone_opacity = std::clamp(settings_.opacity, 0.0, 1.0);
    if (hud_input_.info) view.burr_radius = hud_input_.info->burr_radius_m();
    for (const topics::Viewer& watcher : hud_input_.watchers)
        if (const auto pointer = pointerPlace(watcher)) view.pointers_W.push_back(*pointer);
    if (settings_.camera == CameraMode::kMicroscope) lookThroughMicroscope(view);
    if (hud_input_.tool) showTool(view);
    view.shows_strokes = settings_.show_remarks;
    if (!drawn_.points_W.empty()) view.drawn = drawn_;
    structures_.show(settings_, view);
    return view;
}

void RenderScene::lookThroughMicroscope(FrameView& view) const {
    view.camera = microscopeCamera(view.camera);
    view.light = LightRig::kMicroscope;
    view.is_field_round = true;
    view.has_depth_of_field = settings_.has_depth_of_field;
}

void RenderScene::showTool(FrameView& view) const {
    const topics::ToolState& tool = *hud_input_.tool;
    view.X_WT = readPose(tool.p_wt_m(), tool.q_wt());
    view.X_WT_device = readPose(tool.p_wt_device_m(), tool.q_wt_device());
    view.X_WT_expert = readPose(tool.p_wt_expert_m(), tool.q_wt_expert());
    view.burr_work = burrWorkOf(tool);
    view.burr_load = burrLoadOf(tool);
    view.shows_handpiece = settings_.show_handpiece && settings_.quality == Quality::kFull;
    const auto force_W = readVector(tool.force_n());
    if (settings_.show_force) view.f_T_W = force_W;
    if (pull_W_ && force_W) view.pull = Pull{*pull_W_, force_W->norm()};
    const auto pick = [this](int x, int y) { return renderer_.pick(x, y); };
    if (pull_W_ && can_pick_ && view.X_WT && tool.contacts() == 0 && !followsTool())
        if (const auto gap = burrGap(last_view_, renderer_.pictureSize(), pick))
            view.gap = behindBurr(view, *gap);
    if (!followsTool()) return;
    view.camera = endoscopeCamera(*view.X_WT, view.burr_radius);
    view.light = LightRig::kEndoscope;
    view.is_field_round = true;
}

void RenderScene::draw(int full_width, int height, float ui_scale, GLuint target) {
    usePalette(settings_.is_for_colour_blind);
    if (std::exchange(was_for_colour_blind_, settings_.is_for_colour_blind) != settings_.is_for_colour_blind)
        colourBone();
    const int width = viewWidth(full_width, height);
    const bool is_divided = settings_.stereo == StereoMode::kSideBySide || showsBeside();
    if (view_pending_) applyFirstView(double(is_divided ? width / 2 : width) / height);
    hud_input_.node_count = nodeCount();
    hud_input_.events = events_.show(EventLatch::Clock::now());
    lookForFaults();
    can_pick_ = settings_.stereo == StereoMode::kOff;
    updateCt(full_width, height);
    FrameView view = makeView();
    view.effects = effectPicture();
    if (effects_ && effects_->pulse() && settings_.shows(ViewerEffect::kPulse))
        for (StructureLook& look : view.structures) look.rise = effects_->pulse()->riseOf(look.structure);
    prepareNearStructures(view);
    const PictureArea whole{0, width, height};
    switch (settings_.stereo) {
        case StereoMode::kOff:
            last_view_ = view;
            if (showsBeside()) {
                drawBeside(view, width, height, ui_scale, target);
                break;
            }
            drawEye(view, view.camera, whole, ui_scale, target);
            paintHud(view.camera, whole, ui_scale);
            break;
        case StereoMode::kSideBySide:
            drawSideBySide(view, width, height, ui_scale, target);
            break;
        case StereoMode::kAnaglyph:
            drawAnaglyph(view, width, height, ui_scale, target);
            break;
    }
    paintPanes(full_width, height, ui_scale, target);
    gl_.check("drawing the head-up display");
}

void RenderScene::updateCt(int width, int height) {
    CtShow::View view{settings_, X_WV_, bone_W(), std::nullopt, width, height};
    if (const auto X_WT = toolPose()) view.burr = SliceBurr{X_WT->position, burrRadius()};
    renderer_.hasChanged(ct_.update(view, nodes_));
    renderer_.setFaces(ct_.faces());
    renderer_.setMilledGrey(ct_.milledGrey());
}

void RenderScene::paintPanes(int width, int height, float ui_scale, GLuint target) {
    if (!ct_.hasPanes()) return;
    ct_.paintPanes(target);
    hud_painter_.paintPanes(ct_.texts(hasPatientAxes()), {width, height}, ui_scale);
}

std::optional<Eigen::Vector3d> RenderScene::pick(int x, int y) const {
    if (!can_pick_) return std::nullopt;
    return renderer_.pick(x, y);
}

// What is seen of structures through thin bone is made anew when other structures are shown.
void RenderScene::prepareNearStructures(const FrameView& view) {
    hud_input_.legend.reset();
    if (view.shows_thickness) hud_input_.legend = structures_.legend();
    std::map<uint32_t, Eigen::Vector3f> colours;
    for (const StructureLook& look : view.structures)
        if (look.mode != StructureMode::kOff) colours.emplace(look.structure, look.colour);
    if (near_structures_ == colours) return;
    near_structures_ = std::move(colours);
    const StructureSet& structures = structures_.structures();
    const double reach = std::max(structures.largestWarningDistance(), double(kShineReach));
    renderer_.setNearStructures(nearStructures(structures, *near_structures_, reach));
}

// Names stand in each eye's picture, so that they have the depth of what they name.
void RenderScene::drawEye(FrameView view, const Camera& camera, const PictureArea& area, float ui_scale,
                          GLuint target) {
    view.camera = camera;
    renderer_.draw(view, nodes_, tool_, area, target);
    paintNames(view, area, ui_scale);
}

OrientationAxes RenderScene::orientationOf(const Camera& camera) const {
    const bool are_patients = hasPatientAxes();
    const Eigen::Matrix3d R_CW = camera.R_WC.transpose();
    if (are_patients) return {R_CW.cast<float>(), true};
    return {(R_CW * X_WV_.rotation.toRotationMatrix()).cast<float>(), false};
}

// Needs the framebuffer bound and the viewport set, as the renderer leaves them.
void RenderScene::paintHud(const Camera& camera, const PictureArea& area, float ui_scale) {
    if (!settings_.show_hud) {
        if (const auto alert = alertOf(hud_input_))
            hud_painter_.paintAlert(*alert, {area.width, area.height}, ui_scale);
        return;
    }
    hud_input_.show_details = settings_.show_details;
    hud_input_.show_watchers = settings_.show_watchers;
    hud_input_.show_help = settings_.show_help;
    const double metres_per_pixel = camera.metresPerPixel(area.height);
    hud_input_.is_in_eyes = settings_.stereo == StereoMode::kSideBySide;
    const bool has_bar = hasSceneInfo() && !hud_input_.is_in_eyes;
    const ScaleBar bar = has_bar ? makeScaleBar(metres_per_pixel, 0.2 * area.width) : ScaleBar{};
    Hud hud = makeHud(hud_input_);
    if (hasSceneInfo()) hud.orientation = orientationOf(camera);
    hud_painter_.paint(hud, bar, metres_per_pixel, {area.width, area.height}, ui_scale);
}

}  // namespace bonemill
