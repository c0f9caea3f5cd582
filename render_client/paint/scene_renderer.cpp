#include "render_client/paint/scene_renderer.h"

#include <cmath>
#include <string>
#include <utility>

#include "render_client/paint/clip_planes.h"
#include "render_client/paint/shaders.h"

namespace bonemill {
namespace {

constexpr GLenum kEyePlane = 3;             // number of the clip plane after those of the cuts
constexpr double kOcclusionRadius = 0.10;   // of the bone's radius
constexpr float kOcclusionPicture = 0.06f;  // at most this part of the picture's height
constexpr int kFilterReach = 8;             // pixels that the composite's filter looks beyond

}  // namespace

SceneRenderer::SceneRenderer(const GlApi& gl)
    : gl_(gl),
      bone_(gl),
      markers_(gl),
      tool_(gl, "tool", shaders::kToolVertex, std::string(shaders::kLighting) + shaders::kToolFragment),
      ghost_(gl, "ghost", shaders::kToolVertex, shaders::kGhostFragment),
      shadow_(gl, "shadow", shaders::kShadowVertex, shaders::kDepthFragment),
      background_(gl, "background", shaders::kFullScreenVertex, shaders::kBackgroundFragment),
      occlusion_(gl, "occlusion", shaders::kFullScreenVertex, shaders::kOcclusionFragment),
      composite_(gl, "composite", shaders::kFullScreenVertex, shaders::kCompositeFragment),
      no_attributes_(gl) {}

void SceneRenderer::setPalette(const std::vector<Eigen::Vector4f>& colours) {
    bone_.setPalette(colours);
    has_materials_ = !colours.empty();
    if (film_) film_->setMaterials(has_materials_);
    changes_.forget();
}

void SceneRenderer::prepare(const EffectNeeds& needs) {
    bone_.setFilm(nullptr);
    film_ = needs.film ? std::make_unique<FilmPainter>(gl_, has_materials_) : nullptr;
    particles_ = needs.particles ? std::make_unique<ParticlePainter>(gl_) : nullptr;
    spinning_tool_ = needs.spin ? std::make_unique<Program>(gl_, "turning tool", shaders::kToolVertex,
                                                            std::string("#define SPIN\n") +
                                                                shaders::kLighting + shaders::kToolFragment)
                                : nullptr;
    changes_.forget();
}

void SceneRenderer::draw(const FrameView& view, NodeStore& nodes, const ToolMesh& tool,
                         const PictureArea& area, GLuint target) {
    if (!targets_ || !targets_->suits(area.width, area.height, view.quality)) {
        targets_ = std::make_unique<RenderTargets>(gl_, area.width, area.height, view.quality);
        changes_.forget();
    }
    if (film_) {
        bone_.setFilm(view.effects->shows_blood || view.effects->shows_water ? film_.get() : nullptr);
        film_changed_.extend(film_->update(*view.effects));
    }
    const bool is_quick = view.quality == Quality::kQuick;
    nodes.trackChanges(is_quick);
    const DepthRange needed = Frame::neededRange(view, tool.box());
    const DepthRange range = is_quick ? changes_.range(view.camera, needed) : needed;
    const Frame frame = Frame::make(view, tool.box(), area.aspect(), range);
    last_camera_ = view.camera;
    last_near_far_ = frame.near_far;

    gl_.Disable(GL_BLEND);
    gl_.Disable(GL_CULL_FACE);
    is_quick ? drawQuick(frame, view, nodes, tool, area, target)
             : drawFull(frame, view, nodes, tool, area, target);
    gl_.check("drawing the scene");
}

void SceneRenderer::drawFull(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                             const ToolMesh& tool, const PictureArea& area, GLuint target) {
    drawShadowMap(frame, view, nodes, tool);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
    gl_.Viewport(0, 0, area.width, area.height);
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    drawBackground();
    drawSolids(frame, view, nodes, tool);
    drawParticles(frame, view);
    drawGhost(frame, tool);
    markers_.draw(frame, view);
    targets_->resolve();
    drawOcclusion(frame);
    compose(frame, area.x, target);
}

// The bone of the last picture is kept: where it has changed it is drawn anew, where something moves before
// it it is copied back.
void SceneRenderer::drawQuick(const Frame& frame, const FrameView& view, NodeStore& nodes,
                              const ToolMesh& tool, const PictureArea& area, GLuint target) {
    const PixelBox whole = PixelBox::whole(area.width, area.height);
    PictureChanges::Dirty dirty = changes_.next(frame, area.width, area.height,
                                                nodes.takeChanged().merged(std::exchange(film_changed_, {})),
                                                movingPixels(frame, view, tool));
    if (view.bone_opacity) {  // the tool is seen through it: nothing can be kept
        dirty = {whole, whole};
        changes_.forget();
    }
    const int reach = int(std::ceil(kOcclusionPicture * float(area.height))) + kFilterReach;
    const PixelBox part = dirty.all.isEmpty() ? dirty.all : dirty.all.grown(reach).within(whole);
    gl_.Viewport(0, 0, area.width, area.height);
    gl_.Enable(GL_SCISSOR_TEST);
    if (view.bone_opacity) {
        scissor(whole);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
        gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        drawBackground();
        drawSolids(frame, view, nodes, tool);
    } else if (!part.isEmpty()) {
        drawKeptBone(frame, nodes, dirty.bone);
        scissor(part);
        targets_->copy(targets_->bone(), targets_->scene(), part, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->scene());
        gl_.Enable(GL_DEPTH_TEST);
        drawTool(frame, view, tool);
    }
    if (!part.isEmpty()) {
        drawParticles(frame, view);
        drawGhost(frame, tool);
        markers_.draw(frame, view);
        scissor({part.x0 / 2 - 1, part.y0 / 2 - 1, part.x1 / 2 + 2, part.y1 / 2 + 2});
        drawOcclusion(frame);
        scissor(part);
        compose(frame, 0, targets_->finished());
    }
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, targets_->finished());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    gl_.BlitFramebuffer(0, 0, area.width, area.height, area.x, 0, area.x + area.width, area.height,
                        GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(area.x, 0, area.width, area.height);
}

void SceneRenderer::drawKeptBone(Frame frame, const NodeStore& nodes, const PixelBox& part) {
    if (part.isEmpty()) return;
    scissor(part);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->bone());
    gl_.Clear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    drawBackground();
    frame.cull_from_V = part.zoom(targets_->width(), targets_->height()) * frame.cull_from_V;
    bone_.drawOpaque(frame, nodes, targets_->shadowTexture());
}

PixelBox SceneRenderer::movingPixels(const Frame& frame, const FrameView& view, const ToolMesh& tool) {
    const auto pixels = [&](const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& camera_from_box) {
        return PixelBox::around(box, frame.clip_from_camera * camera_from_box, targets_->width(),
                                targets_->height());
    };
    PixelBox moving = pixels(markers_.box(frame, view), Eigen::Matrix4f::Identity());
    if (particles_ && !view.effects->particles.empty())
        moving =
            moving.joined(pixels(ParticlePainter::box(frame, view.effects->particles, targets_->height()),
                                 Eigen::Matrix4f::Identity()));
    if (frame.camera_from_T) moving = moving.joined(pixels(tool.box(), *frame.camera_from_T));
    if (frame.camera_from_ghost) moving = moving.joined(pixels(tool.box(), *frame.camera_from_ghost));
    return moving;
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
    const double tangent = last_camera_.halfTangent();
    const double aspect = double(targets_->width()) / targets_->height();
    const double right = (2 * (x + 0.5) / targets_->width() - 1) * tangent * aspect + last_camera_.shift;
    const double up = (1 - 2 * (y + 0.5) / targets_->height()) * tangent;
    return last_camera_.eye + last_camera_.R_WC * (depth * Eigen::Vector3d(right, up, -1));
}

// Transparent bone casts no shadow: what is seen through it would be dark.
void SceneRenderer::drawShadowMap(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                                  const ToolMesh& tool) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->shadow());
    gl_.Viewport(0, 0, RenderTargets::kShadowSize, RenderTargets::kShadowSize);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Enable(GL_DEPTH_CLAMP);  // casters between the light and the map's near plane still cast
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    if (view.is_lit_from_eye) gl_.Enable(GL_CLIP_DISTANCE0 + kEyePlane);
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
        nodes.draw(shadow_, aim(frame.camera_from_V));
    }
    if (frame.camera_from_T) {
        aim(*frame.camera_from_T);
        shadow_.set("origin", Eigen::Vector3f(Eigen::Vector3f::Zero()));
        shadow_.set("step", Eigen::Vector3f(Eigen::Vector3f::Ones()));
        tool.draw();
    }
    gl_.Disable(GL_CLIP_DISTANCE0 + kEyePlane);
    gl_.Disable(GL_DEPTH_CLAMP);
}

void SceneRenderer::drawBackground() const {
    gl_.Disable(GL_DEPTH_TEST);
    background_.use();
    drawFullScreen();
    gl_.Enable(GL_DEPTH_TEST);
}

void SceneRenderer::drawSolids(const Frame& frame, const FrameView& view, const NodeStore& nodes,
                               const ToolMesh& tool) {
    const auto draw_tool = [&] { drawTool(frame, view, tool); };
    if (view.bone_opacity)
        return bone_.drawTransparent(frame, nodes, targets_->shadowTexture(), *view.bone_opacity, draw_tool);
    bone_.drawOpaque(frame, nodes, targets_->shadowTexture());
    draw_tool();
}

void SceneRenderer::drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool) const {
    if (!frame.camera_from_T) return;
    const Eigen::Vector3f glow = view.burr_work == BurrWork::kRemoving ? Eigen::Vector3f(1.9f, 0.30f, 0.02f)
                                 : view.burr_work == BurrWork::kAdding ? Eigen::Vector3f(0.05f, 0.75f, 1.1f)
                                                                       : Eigen::Vector3f(0, 0, 0);
    const bool spins = spinning_tool_ && view.effects->turn;
    const Program& program = spins ? *spinning_tool_ : tool_;
    program.use();
    frame.setLight(gl_, program, targets_->shadowTexture());
    program.set("camera_from_model", *frame.camera_from_T);
    program.set("burr_radius", float(view.burr_radius));
    program.set("milling_glow", glow);
    if (spins) {
        program.set("spin_angle", view.effects->turn->angle);
        program.set("spin_sweep", view.effects->turn->sweep);
        program.set("flutes", view.effects->turn->flutes);
    }
    tool.draw();
}

// Seen through the bone too, but fainter there: the hand usually is inside when the tool is stopped at the
// surface.
void SceneRenderer::drawGhost(const Frame& frame, const ToolMesh& tool) const {
    if (!frame.camera_from_ghost) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.Enable(GL_CULL_FACE);
    gl_.DepthMask(GL_FALSE);
    ghost_.use();
    ghost_.set("camera_from_model", *frame.camera_from_ghost);
    ghost_.set("clip_from_camera", frame.clip_from_camera);
    constexpr struct {
        GLenum depth_test;
        float strength;
    } kPasses[] = {{GL_GREATER, 0.6f}, {GL_LEQUAL, 0.8f}};
    for (const auto& pass : kPasses) {
        gl_.DepthFunc(pass.depth_test);
        ghost_.set("strength", pass.strength);
        tool.draw();
    }
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
}

void SceneRenderer::drawOcclusion(const Frame& frame) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_->occlusion());
    gl_.Viewport(0, 0, targets_->occlusionWidth(), targets_->occlusionHeight());
    gl_.Disable(GL_DEPTH_TEST);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, targets_->depthTexture());
    occlusion_.use();
    occlusion_.set("depth_map", 0);
    occlusion_.set("near_far", frame.near_far);
    occlusion_.set("tangents", frame.tangents);
    occlusion_.set("shift", frame.shift);
    occlusion_.set("radius", float(kOcclusionRadius) * frame.bone_radius);
    occlusion_.set("max_radius", kOcclusionPicture);
    drawFullScreen();
}

void SceneRenderer::compose(const Frame& frame, int x, GLuint target) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Viewport(x, 0, targets_->width(), targets_->height());
    const GLuint textures[] = {targets_->colourTexture(), targets_->depthTexture(),
                               targets_->occlusionTexture()};
    for (GLenum unit = 0; unit < 3; ++unit) {
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(GL_TEXTURE_2D, textures[unit]);
    }
    composite_.use();
    composite_.set("colour_map", 0);
    composite_.set("depth_map", 1);
    composite_.set("occlusion_map", 2);
    composite_.set("near_far", frame.near_far);
    composite_.set("depth_tolerance", 0.5f * float(kOcclusionRadius) * frame.bone_radius);
    drawFullScreen();
    gl_.ActiveTexture(GL_TEXTURE0);
}

void SceneRenderer::drawFullScreen() const {
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
