#include "render_client/look/paint/scene_renderer.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/picture_parts.h"

namespace bonemill {
namespace {

// A long thing is seen as so many boxes, which together lie closer around it than one.
constexpr int kToolSlices = 12, kShadowSlices = 12;

bool showsBehindBone(const FrameView& view) {
    return std::ranges::any_of(view.structures,
                               [](auto& look) { return look.mode == StructureMode::kThroughBone; });
}

}  // namespace

SceneRenderer::SceneRenderer(const GlApi& gl)
    : gl_(gl), bone_(gl), tool_(gl), markers_(gl), passes_(gl), structures_(gl), strokes_(gl), drawn_(gl) {}

void SceneRenderer::setPalette(const std::vector<Eigen::Vector4f>& colours) {
    bone_.setPalette(colours);
    changes_.forget();
}

void SceneRenderer::prepare(const DrawnEffects& needs) {
    bone_.setFilm(nullptr);
    structures_.setFilm(nullptr);
    film_ = needs.film ? std::make_unique<FilmPainter>(gl_) : nullptr;
    particles_ = needs.particles ? std::make_unique<ParticlePainter>(gl_) : nullptr;
    tool_.prepareSpin(needs.spin);
    changes_.forget();
}

void SceneRenderer::draw(const FrameView& view, NodeStore& nodes, const ToolMesh& tool,
                         const PictureArea& area, GLuint target) {
    prepareTargets(area, view.quality);
    chooseSurface(view);
    if (film_) {
        bone_.setFilm(view.effects->showsFilm() ? film_.get() : nullptr);
        structures_.setFilm(view.effects->shows_bruises ? film_.get() : nullptr);
        std::ranges::copy(film_->update(*view.effects), std::back_inserter(look_changed_));
    }
    const DepthRange range =
        changes_.range(view.camera, Frame::neededRange(view, tool.box(view.shows_handpiece)));
    const Frame frame = Frame::make(view, tool.box(view.shows_handpiece), area.aspect(), range);
    last_camera_ = view.camera;
    last_near_far_ = frame.near_far;

    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_SCISSOR_TEST);
    PictureChanges::Changed changed = takeChanges(frame, view, nodes, tool);
    const Shown shown{frame, view, nodes, tool};
    view.bone_opacity ? drawThrough(shown) : drawKept(shown, std::move(changed));
    gl_.Disable(GL_SCISSOR_TEST);
    showFinished(area, target);
    gl_.check("drawing the scene");
}

void SceneRenderer::prepareTargets(const PictureArea& area, Quality quality) {
    if (targets_ && targets_->suits(area.width, area.height, quality)) return;
    targets_ = std::make_unique<RenderTargets>(gl_, area.width, area.height, quality);
    shadow_ = std::make_unique<ShadowMap>(gl_, quality == Quality::kFull ? ShadowMap::kSize : 1);
    changes_.forget();
}

PictureChanges::Changed SceneRenderer::takeChanges(const Frame& frame, const FrameView& view,
                                                   NodeStore& nodes, const ToolMesh& tool) {
    return {nodes.takeChanged().merged(structures_.takeChanged(view.structures)),
            std::exchange(look_changed_, {}), movingPixels(frame, view, tool), stillLike(frame, view, tool)};
}

void SceneRenderer::setNearStructures(const NearStructures& near) {
    near_ = near.samples.empty() ? nullptr : std::make_unique<NearStructurePainter>(gl_, near);
    bone_.setNearStructures(near_.get());
    changes_.forget();
}

void SceneRenderer::chooseSurface(const FrameView& view) {
    bone_.showThickness(view.shows_thickness);
    if (std::exchange(shows_thickness_, view.shows_thickness) != view.shows_thickness) changes_.forget();
    if (std::exchange(shows_strokes_, view.shows_strokes) != view.shows_strokes) changes_.forget();
    drawn_.set(view.drawn ? std::vector<Stroke>{*view.drawn} : std::vector<Stroke>{});
}

// Draws what comes over bone and tool; the depth stays as it is.
void SceneRenderer::drawOver(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    drawParticles(frame, view);
    tool_.drawGhosts(frame, tool);
    drawn_.draw(frame, view);
    markers_.draw(frame, view);
}

// The tool is seen through the bone: nothing can be kept. Transparent bone casts no shadow: what is seen
// through it would be dark.
void SceneRenderer::drawThrough(const Shown& shown) {
    const Frame& frame = shown.frame;
    const FrameView& view = shown.view;
    const ToolMesh& tool = shown.tool;
    const PixelTiles whole = PixelTiles::whole(targets_->width(), targets_->height());
    changes_.forget();
    if (frame.has_shadow) shadow_->draw(frame, shown.nodes, tool, false);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Viewport(0, 0, targets_->width(), targets_->height());
    setScissor(gl_, whole.bounds());
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    passes_.drawBackground(whole.boxes());
    bone_.drawTransparent(frame, shown.nodes, targets_->sceneLayer(), shadow_->texture(), *view.bone_opacity,
                          [&] {
                              structures_.drawSolid(frame, view.structures, shadow_->texture());
                              tool_.drawTool(frame, view, tool, shadow_->texture());
                          });
    if (view.shows_strokes) strokes_.draw(frame, view);
    drawOver(frame, view, tool);
    targets_->resolve(whole.boxes());
    passes_.drawOcclusion(frame, *targets_, targets_->depthTexture(), whole.boxes());
    finish(frame, whole);
}

// The bone of the last picture is kept. Where it has changed it is drawn anew, where it only looks different
// it is shaded anew (a cap and what is blended over bone cannot be), and where something moves before it, it
// is copied back. In quick quality what moves takes no part in the occlusion, which would have to be made
// anew in every picture, far around it.
void SceneRenderer::drawKept(const Shown& shown, PictureChanges::Changed changed) {
    const Frame& frame = shown.frame;
    const int width = targets_->width(), height = targets_->height();
    const Eigen::AlignedBox3f changed_V = changed.bone_V;
    PictureChanges::Dirty dirty = changes_.next(frame, width, height, std::move(changed));
    if (frame.has_shadow) updateShadow(shown, changed_V, dirty);
    if (frame.cuts_V.any() || showsBehindBone(shown.view)) {
        dirty.bone = dirty.bone.joined(dirty.look.bounds());
        dirty.look = PixelTiles(width, height);
    }
    gl_.Viewport(0, 0, width, height);
    drawBone(shown, dirty.bone);
    drawLook(shown, dirty.look);
    PixelTiles reshaped(width, height), drawn = dirty.look;
    reshaped.add(dirty.bone);
    const bool is_quick = shown.view.quality == Quality::kQuick;
    if (!is_quick) reshaped.add(dirty.moving);
    drawn.add(dirty.bone);
    drawn.add(dirty.moving);
    if (drawn.isEmpty()) return;
    const PixelTiles occluded = reshaped.grown(FramePasses::reach(height));
    if (is_quick) passes_.drawOcclusion(frame, *targets_, targets_->boneDepthTexture(), occluded.boxes());
    drawTool(shown, drawn);
    targets_->resolve(drawn.boxes());
    if (!is_quick) passes_.drawOcclusion(frame, *targets_, targets_->depthTexture(), occluded.boxes());
    PixelTiles finished = drawn.grown(FramePasses::blurReach(frame, height));
    finished.add(occluded);
    finish(frame, finished);
}

void SceneRenderer::updateShadow(const Shown& shown, const Eigen::AlignedBox3f& changed_V,
                                 PictureChanges::Dirty& dirty) {
    if (dirty.is_whole) return shadow_->draw(shown.frame, shown.nodes, shown.tool, true);
    addShadowed(shown, shadow_->update(shown.frame, shown.nodes, shown.tool, changed_V), dirty.look);
}

// A shadow falls away from the light through these boxes of its clip space, as far as there is something.
void SceneRenderer::addShadowed(const Shown& shown, const std::vector<Eigen::AlignedBox3f>& boxes,
                                PixelTiles& tiles) const {
    const Frame& frame = shown.frame;
    const Eigen::Matrix4f shadow_from_V = frame.key.shadow_from_camera * frame.X_CV;
    const Eigen::AlignedBox3f lit_V = shown.nodes.box().merged(shown.view.structures_V.cast<float>());
    Eigen::AlignedBox1f depth;
    for (int i = 0; i < 8 && !lit_V.isEmpty(); ++i) {
        const auto corner = lit_V.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
        depth.extend(Eigen::Vector<float, 1>(shadow_from_V.row(2).dot(corner.homogeneous())));
    }
    const Eigen::Matrix4f camera_from_shadow = frame.key.shadow_from_camera.inverse();
    for (Eigen::AlignedBox3f box : boxes) {
        box.min().z() = std::max(box.min().z(), depth.min().x());
        box.max().z() = depth.max().x();
        for (const Eigen::AlignedBox3f& slice : sliced(box, 2, kShadowSlices))
            tiles.add(pixelsOf(frame, slice, camera_from_shadow));
    }
}

void SceneRenderer::drawBone(const Shown& shown, const PixelBox& part) {
    if (part.isEmpty()) return;
    Frame frame = shown.frame;
    frame.cull_from_V = part.zoom(targets_->width(), targets_->height()) * frame.cull_from_V;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->bone());
    setScissor(gl_, part);
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    passes_.drawBackground({part.grown(kScissorRim)});
    bone_.drawOpaque(frame, shown.nodes, targets_->keptLayer(), part, shadow_->texture());
    structures_.draw(frame, shown.view.structures, shadow_->texture());
    if (shown.view.shows_strokes) strokes_.draw(frame, shown.view);
}

// What is drawn on the bone comes back in the box around the parts, where it is as it was.
void SceneRenderer::drawLook(const Shown& shown, const PixelTiles& parts) {
    if (parts.isEmpty()) return;
    Frame frame = shown.frame;
    const PixelBox around = parts.bounds();
    frame.cull_from_V = around.zoom(targets_->width(), targets_->height()) * frame.cull_from_V;
    std::vector<PixelBox> boxes = parts.boxes();
    for (PixelBox& box : boxes) box = box.grown(kScissorRim);
    bone_.shadeAgain(frame, targets_->keptLayer(), shadow_->texture(), boxes,
                     [&](const PixelBox& part) { passes_.drawBackground({part}); });
    setScissor(gl_, around.grown(kScissorRim));
    structures_.drawAgain(frame, shown.view.structures, shadow_->texture());
    if (shown.view.shows_strokes) strokes_.draw(frame, shown.view);
}

void SceneRenderer::drawTool(const Shown& shown, const PixelTiles& parts) {
    const auto& [frame, view, nodes, tool] = shown;
    copyParts(gl_, targets_->bone(), targets_->scene(), parts.boxes(),
              GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    setScissor(gl_, parts.bounds().grown(kScissorRim));
    gl_.Enable(GL_DEPTH_TEST);
    tool_.drawTool(frame, view, tool, shadow_->texture());
    drawOver(frame, view, tool);
}

void SceneRenderer::finish(const Frame& frame, const PixelTiles& parts) {
    passes_.compose(frame, *targets_, parts.boxes());
    PixelTiles shadowed(targets_->width(), targets_->height());
    for (const PixelBox& box : shadowPixels(frame)) shadowed.add(box);
    shadowed.keep(parts);
    if (!shadowed.isEmpty()) passes_.drawToolShadow(frame, *targets_, shadowed.boxes());
}

void SceneRenderer::showFinished(const PictureArea& area, GLuint target) const {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->finished());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    gl_.BlitFramebuffer(0, 0, area.width, area.height, area.x, area.height, area.x + area.width, 0,
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(area.x, 0, area.width, area.height);
}

PixelBox SceneRenderer::pixelsOf(const Frame& frame, const Eigen::AlignedBox3f& box,
                                 const Eigen::Matrix4f& X_CB) const {
    return PixelBox::around(box, frame.clip_from_camera * X_CB, targets_->width(), targets_->height());
}

std::vector<PixelBox> SceneRenderer::shadowPixels(const Frame& frame) const {
    std::vector<PixelBox> pixels;
    if (!frame.tool_shadow) return pixels;
    for (const Eigen::AlignedBox3f& box : frame.tool_shadow->boxes(frame.key.direction))
        pixels.push_back(pixelsOf(frame, box, Eigen::Matrix4f::Identity()));
    return pixels;
}

PixelTiles SceneRenderer::movingPixels(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    const Eigen::Matrix4f X_CC = Eigen::Matrix4f::Identity();
    PixelTiles moving(targets_->width(), targets_->height());
    moving.add(pixelsOf(frame, markers_.box(frame, view), X_CC));
    if (view.drawn) moving.add(pixelsOf(frame, StrokePainter::box(*view.drawn, frame, view), X_CC));
    if (particles_)
        for (const Eigen::AlignedBox3f& box :
             ParticlePainter::boxes(frame, view.effects->particles, targets_->height()))
            moving.add(pixelsOf(frame, box, X_CC));
    for (const PixelBox& box : shadowPixels(frame)) moving.add(box);
    if (frame.X_CT) addTool(frame, tool.box(view.shows_handpiece), *frame.X_CT, moving);
    for (const Ghost& ghost : frame.ghosts) addTool(frame, tool.box(), ghost.X_CT, moving);
    return moving;
}

void SceneRenderer::addTool(const Frame& frame, const Eigen::AlignedBox3f& tool_T,
                            const Eigen::Matrix4f& X_CT, PixelTiles& tiles) const {
    for (const Eigen::AlignedBox3f& slice : sliced(tool_T, kToolSlices))
        tiles.add(pixelsOf(frame, slice, X_CT));
}

// Says how what moves stands, in numbers; nothing while the burr's flutes turn.
std::vector<float> SceneRenderer::stillLike(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    const auto turn = view.effects ? view.effects->turn : std::nullopt;
    if (turn && turn->sweep != 0) return {};
    std::vector<float> numbers{float(view.burr_work),         float(view.burr_load),
                               float(view.burr_radius),       float(tool.revision()),
                               float(view.pointers_W.size()), float(view.pull.has_value()),
                               turn ? turn->angle : 0,        turn ? turn->flutes : 0};
    const auto append = [&numbers](const auto& matrix) {
        const auto f = matrix.template cast<float>().eval();
        numbers.insert(numbers.end(), f.data(), f.data() + f.size());
    };
    for (const Particle& particle : view.effects ? view.effects->particles : Particles{}) {
        append(particle.p_V), append(particle.streak_V), append(particle.colour);
        numbers.insert(numbers.end(), {particle.radius, particle.gloss});
    }
    numbers.push_back(float(frame.X_CT.has_value()));
    if (frame.X_CT) append(*frame.X_CT);
    for (const Ghost& ghost : frame.ghosts) append(ghost.X_CT), append(ghost.colour);
    append(view.f_T_W.value_or(Eigen::Vector3d::Zero()));
    if (view.pull) append(view.pull->wish_W);
    if (view.pull) numbers.push_back(float(view.pull->newtons));
    if (view.gap) append(view.gap->surface_W);
    if (view.gap) numbers.push_back(float(view.gap->distance));
    for (const Eigen::Vector3d& pointer : view.pointers_W) append(pointer);
    if (view.drawn)
        for (const Eigen::Vector3f& point : view.drawn->points_W) append(point);
    if (view.clearance) append(view.clearance->burr_W);
    if (view.clearance) append(view.clearance->structure_W);
    return numbers;
}

void SceneRenderer::drawParticles(const Frame& frame, const FrameView& view) {
    if (particles_) particles_->draw(frame, view.effects->particles, targets_->height(), shadow_->texture());
}

std::optional<Eigen::Vector3d> SceneRenderer::pick(int x, int y) const {
    if (!targets_) return std::nullopt;
    const auto stored = targets_->depthAt(x, y);
    if (!stored) return std::nullopt;
    const double near = last_near_far_.x(), far = last_near_far_.y();
    const double depth = 2 * near * far / (near + far - (2.0 * *stored - 1) * (far - near));
    return last_camera_.eye_W + depth * last_camera_.rayThrough(x, y, targets_->width(), targets_->height());
}

}  // namespace bonemill
