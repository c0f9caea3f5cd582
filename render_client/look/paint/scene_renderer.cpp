#include "render_client/look/paint/scene_renderer.h"

#include <utility>

#include "render_client/look/paint/frame.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr GLenum kEyePlane = 3;  // number of the clip plane after those of the cuts

}  // namespace

SceneRenderer::SceneRenderer(const GlApi& gl)
    : gl_(gl),
      bone_(gl),
      tool_(gl),
      markers_(gl),
      passes_(gl),
      shadow_(gl, "shadow", shaders::kShadowVertex, shaders::kDepthFragment),
      structures_(gl),
      strokes_(gl),
      drawn_(gl) {}

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
    if (!targets_ || !targets_->suits(area.width, area.height, view.quality)) {
        targets_ = std::make_unique<RenderTargets>(gl_, area.width, area.height, view.quality);
        changes_.forget();
    }
    chooseSurface(view);
    if (film_) {
        bone_.setFilm(view.effects->showsFilm() ? film_.get() : nullptr);
        structures_.setFilm(view.effects->shows_bruises ? film_.get() : nullptr);
        look_changed_.extend(film_->update(*view.effects));
    }
    const bool is_quick = view.quality == Quality::kQuick;
    nodes.trackChanges(is_quick);
    const DepthRange needed = Frame::neededRange(view, tool.box(view.shows_handpiece));
    const DepthRange range = is_quick ? changes_.range(view.camera, needed) : needed;
    const Frame frame = Frame::make(view, tool.box(view.shows_handpiece), area.aspect(), range);
    last_camera_ = view.camera;
    last_near_far_ = frame.near_far;

    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    is_quick ? drawQuick(frame, view, nodes, tool, area, target)
             : drawFull(frame, view, nodes, tool, area, target);
    gl_.check("drawing the scene");
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

void SceneRenderer::drawStrokes(const Frame& frame, const FrameView& view) const {
    if (view.shows_strokes) strokes_.draw(frame, view);
}

void SceneRenderer::drawFull(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                             const ToolMesh& tool, const PictureArea& area, GLuint target) {
    drawShadowMap(frame, view, nodes, tool);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Viewport(0, 0, area.width, area.height);
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    passes_.drawBackground();
    drawSolids(frame, view, nodes, tool);
    drawOver(frame, view, tool);
    targets_->resolve();
    passes_.drawOcclusion(frame, *targets_, targets_->depthTexture());
    passes_.compose(frame, *targets_, area.x, target);
}

// Draws what comes over bone and tool; the depth stays as it is.
void SceneRenderer::drawOver(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    drawParticles(frame, view);
    tool_.drawGhosts(frame, tool);
    drawn_.draw(frame, view);
    markers_.draw(frame, view);
}

// The bone of the last picture is kept, with its occlusion. Where it has changed both are drawn anew, and
// where something moves before it, it is copied back. What moves takes no part in the occlusion: it would
// have to be made anew in every picture, far around it.
void SceneRenderer::drawQuick(const Frame& frame, const FrameView& view, NodeStore& nodes,
                              const ToolMesh& tool, const PictureArea& area, GLuint target) {
    const PixelBox whole = PixelBox::whole(area.width, area.height);
    const PictureChanges::Dirty dirty =
        changes_.next(frame, area.width, area.height,
                      nodes.takeChanged()
                          .merged(std::exchange(look_changed_, {}))
                          .merged(structures_.takeChanged(view.structures)),
                      movingPixels(frame, view, tool), stillLike(frame, view, tool));
    gl_.Viewport(0, 0, area.width, area.height);
    gl_.Enable(GL_SCISSOR_TEST);
    if (view.bone_opacity) {  // the tool is seen through it: nothing can be kept
        changes_.forget();
        drawAllSolids(frame, view, nodes, tool);
        drawOcclusion(frame, whole, targets_->depthTexture());
        finishQuick(frame, whole);
    } else if (!dirty.all.isEmpty()) {
        const PixelBox occluded = grown(dirty.bone, FramePasses::reach(area.height));
        drawKeptBone(frame, view, nodes, dirty.bone);
        drawOcclusion(frame, occluded, targets_->boneDepthTexture());
        drawToolOverKeptBone(frame, view, tool, dirty.all);
        finishQuick(frame, grown(dirty.all, FramePasses::blurReach(frame, area.height)).joined(occluded));
    }
    gl_.Disable(GL_SCISSOR_TEST);
    showFinished(area, target);
}

void SceneRenderer::drawAllSolids(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                                  const ToolMesh& tool) {
    scissor(PixelBox::whole(targets_->width(), targets_->height()));
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    passes_.drawBackground();
    drawSolids(frame, view, nodes, tool);
    drawOver(frame, view, tool);
}

void SceneRenderer::drawToolOverKeptBone(const Frame& frame, const FrameView& view, const ToolMesh& tool,
                                         const PixelBox& part) {
    scissor(part);
    targets_->copy(targets_->bone(), targets_->scene(), part, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Enable(GL_DEPTH_TEST);
    tool_.drawTool(frame, view, tool, targets_->shadowTexture());
    drawOver(frame, view, tool);
}

PixelBox SceneRenderer::grown(const PixelBox& part, int pixels) const {
    const PixelBox whole = PixelBox::whole(targets_->width(), targets_->height());
    return part.isEmpty() ? part : part.grown(pixels).within(whole);
}

// Leaves the viewport that of the picture.
void SceneRenderer::drawOcclusion(const Frame& frame, const PixelBox& part, GLuint depth_texture) const {
    if (part.isEmpty()) return;
    scissor({part.x0 / 2 - 1, part.y0 / 2 - 1, part.x1 / 2 + 2, part.y1 / 2 + 2});  // half the size
    passes_.drawOcclusion(frame, *targets_, depth_texture);
    gl_.Viewport(0, 0, targets_->width(), targets_->height());
}

void SceneRenderer::finishQuick(const Frame& frame, const PixelBox& part) {
    scissor(part);
    passes_.compose(frame, *targets_, 0, targets_->finished());
    if (!frame.tool_shadow) return;
    const PixelBox shadowed = shadowPixels(frame).within(part);
    if (shadowed.isEmpty()) return;
    scissor(shadowed);
    passes_.drawToolShadow(frame, *targets_, targets_->finished());
}

void SceneRenderer::showFinished(const PictureArea& area, GLuint target) const {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->finished());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    gl_.BlitFramebuffer(0, 0, area.width, area.height, area.x, 0, area.x + area.width, area.height,
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(area.x, 0, area.width, area.height);
}

void SceneRenderer::drawKeptBone(Frame frame, const FrameView& view, const NodeStore& nodes,
                                 const PixelBox& part) {
    if (part.isEmpty()) return;
    scissor(part);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->bone());
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    passes_.drawBackground();
    frame.cull_from_V = part.zoom(targets_->width(), targets_->height()) * frame.cull_from_V;
    bone_.drawOpaque(frame, nodes, targets_->keptLayer(), targets_->shadowTexture());
    structures_.draw(frame, view.structures, targets_->shadowTexture());
    drawStrokes(frame, view);
}

PixelBox SceneRenderer::shadowPixels(const Frame& frame) const {
    return PixelBox::around(frame.tool_shadow->box(frame.key.direction), frame.clip_from_camera,
                            targets_->width(), targets_->height());
}

PixelBox SceneRenderer::movingPixels(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    const auto pixels = [&](const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& X_CB) {
        return PixelBox::around(box, frame.clip_from_camera * X_CB, targets_->width(), targets_->height());
    };
    PixelBox moving = pixels(markers_.box(frame, view), Eigen::Matrix4f::Identity());
    if (view.drawn)
        moving =
            moving.joined(pixels(StrokePainter::box(*view.drawn, frame, view), Eigen::Matrix4f::Identity()));
    if (particles_ && !view.effects->particles.empty())
        moving =
            moving.joined(pixels(ParticlePainter::box(frame, view.effects->particles, targets_->height()),
                                 Eigen::Matrix4f::Identity()));
    if (frame.tool_shadow) moving = moving.joined(shadowPixels(frame));
    if (frame.X_CT) moving = moving.joined(pixels(tool.box(view.shows_handpiece), *frame.X_CT));
    for (const Ghost& ghost : frame.ghosts) moving = moving.joined(pixels(tool.box(), ghost.X_CT));
    return moving;
}

// Says how what moves stands, in numbers; nothing while particles fly or the burr's flutes turn.
std::vector<float> SceneRenderer::stillLike(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    const bool has_effects = view.effects && (view.effects->turn || !view.effects->particles.empty());
    if (has_effects) return {};
    std::vector<float> numbers{float(view.burr_work),         float(view.burr_load),
                               float(view.burr_radius),       float(tool.revision()),
                               float(view.pointers_W.size()), float(view.pull.has_value())};
    const auto append = [&numbers](const auto& matrix) {
        const auto f = matrix.template cast<float>().eval();
        numbers.insert(numbers.end(), f.data(), f.data() + f.size());
    };
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
    if (particles_)
        particles_->draw(frame, view.effects->particles, targets_->height(), targets_->shadowTexture());
}

void SceneRenderer::scissor(const PixelBox& part) const {
    gl_.Scissor(part.x0, part.y0, part.width(), part.height());
}

std::optional<Eigen::Vector3d> SceneRenderer::pick(int x, int y) const {
    if (!targets_) return std::nullopt;
    const auto stored = targets_->depthAt(x, y);
    if (!stored) return std::nullopt;
    const double near = last_near_far_.x(), far = last_near_far_.y();
    const double depth = 2 * near * far / (near + far - (2.0 * *stored - 1) * (far - near));
    return last_camera_.eye_W + depth * last_camera_.rayThrough(x, y, targets_->width(), targets_->height());
}

// Transparent bone casts no shadow: what is seen through it would be dark.
void SceneRenderer::drawShadowMap(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                                  const ToolMesh& tool) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->shadow());
    gl_.Viewport(0, 0, RenderTargets::kShadowSize, RenderTargets::kShadowSize);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    if (view.light != LightRig::kRoom) gl_.Enable(GL_CLIP_DISTANCE0 + kEyePlane);
    shadow_.use();
    const auto aim = [&](const Eigen::Matrix4f& camera_from_model) {
        const Eigen::Matrix4f shadow_from_model = frame.key.shadow_from_camera * camera_from_model;
        shadow_.set("clip_from_model", shadow_from_model);
        shadow_.set("eye_plane", Eigen::Vector4f(-camera_from_model.row(2).transpose()));
        return shadow_from_model;
    };
    if (!view.bone_opacity) {
        const ClipPlanes clip(gl_, frame.cuts_V);
        setCutPlanes(shadow_, frame.cuts_V);
        nodes.draw(shadow_, aim(frame.X_CV));
    }
    if (frame.X_CT) {
        aim(*frame.X_CT);
        shadow_.set("origin", Eigen::Vector3f(Eigen::Vector3f::Zero()));
        shadow_.set("step", Eigen::Vector3f(Eigen::Vector3f::Ones()));
        tool.draw();
    }
    gl_.Disable(GL_CLIP_DISTANCE0 + kEyePlane);
}

void SceneRenderer::drawSolids(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                               const ToolMesh& tool) {
    const auto draw_tool = [&] { tool_.drawTool(frame, view, tool, targets_->shadowTexture()); };
    if (view.bone_opacity) {
        bone_.drawTransparent(frame, nodes, targets_->sceneLayer(), targets_->shadowTexture(),
                              *view.bone_opacity, [&] {
                                  structures_.drawSolid(frame, view.structures, targets_->shadowTexture());
                                  draw_tool();
                              });
        return drawStrokes(frame, view);
    }
    bone_.drawOpaque(frame, nodes, targets_->sceneLayer(), targets_->shadowTexture());
    structures_.draw(frame, view.structures, targets_->shadowTexture());
    drawStrokes(frame, view);
    draw_tool();
}

}  // namespace bonemill
