#include "render_client/look/paint/bone_painter.h"

#include <algorithm>
#include <string>

#include "render_client/look/model/material_palette.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

// Units of textures; 0 is the shadow's, 2 the palette's.
constexpr GLenum kFilmUnit = 1, kNearUnit = 3;

constexpr double kGrain = 0.045;  // size of the mottling over the bone's radius
constexpr GLuint kAllBits = 0xff;
constexpr GLint kOpened = 0x80;  // stencil: the nearest surface is seen from within
constexpr float kFarWallOpacity = 0.28f;
constexpr GLuint kLayers = 0x7f;           // stencil: how many front faces there are
constexpr float kLastWallOpacity = 0.12f;  // of a wall seen from within, when nothing is behind it
constexpr float kWallOpacity = 0.45f;      // of the nearest wall seen from within
constexpr float kBoxMargin = 0.01f;        // of the bone's radius: the box is that of points on the surface
constexpr float kCapOpacity = 0.15f;       // above the surface's
constexpr float kOutline = 0.80f;          // what is left of it is added at the outline

const Eigen::Vector3f kInsideSolid(0.42f, 0.16f, 0.12f);
const Eigen::Vector3f kInsideGlass(0.85f, 0.22f, 0.10f);

}  // namespace

FilmPainter::FilmPainter(const GlApi& gl) : gl_(gl), texture_(gl) {
    constexpr int kCells = SurfaceFilm::kCells;
    gl_.ActiveTexture(GL_TEXTURE0 + kFilmUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kCells, kCells, kCells, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.setSampling(GL_TEXTURE_3D, GL_LINEAR, GL_REPEAT);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.check("making the film's texture");
}

std::vector<Eigen::AlignedBox3f> FilmPainter::update(const EffectPicture& picture) {
    SurfaceFilm& film = *picture.film;
    const Eigen::Vector4f strength(picture.shows_blood, picture.shows_water, picture.shows_burns,
                                   picture.shows_bruises);
    if (!film.takeDue() && strength == strength_) return {};
    std::vector<Eigen::AlignedBox3f> changed = film.takeChanged();
    if (strength != strength_) changed.push_back(film.shownBox());
    strength_ = strength;
    blood_colour_ = picture.blood_colour;
    period_ = film.extent();
    shown_ = film.shownBox();
    const auto slices = film.takeChangedSlices();
    if (slices.none()) return changed;
    constexpr int kCells = SurfaceFilm::kCells;
    gl_.ActiveTexture(GL_TEXTURE0 + kFilmUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int z = 0; z < kCells; ++z)
        if (slices[size_t(z)])
            gl_.TexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, z, kCells, kCells, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                              film.slice(z).data());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.ActiveTexture(GL_TEXTURE0);
    return changed;
}

void FilmPainter::setUniforms(const Program& program) const {
    gl_.bindTexture(kFilmUnit, GL_TEXTURE_3D, texture_.name());
    program.set("film", int(kFilmUnit));
    program.set("film_period", period_);
    const bool is_anywhere = !shown_.isEmpty();
    program.set("film_low", is_anywhere ? shown_.min() : Eigen::Vector3f::Ones().eval());
    program.set("film_high", is_anywhere ? shown_.max() : Eigen::Vector3f::Zero().eval());
    program.set("film_strength", strength_);
    program.set("blood_colour", blood_colour_);
}

NearStructurePainter::NearStructurePainter(const GlApi& gl, const NearStructures& near)
    : gl_(gl),
      texture_(gl),
      // A texture's corner is half a sample before its first one.
      first_V_(near.first_V - Eigen::Vector3f::Constant(0.5f * near.step)),
      extent_(near.step * near.size.cast<float>()),
      reach_(near.reach) {
    gl_.ActiveTexture(GL_TEXTURE0 + kNearUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, near.size.x(), near.size.y(), near.size.z(), 0, GL_RGBA,
                   GL_UNSIGNED_BYTE, near.samples.data());
    gl_.setSampling(GL_TEXTURE_3D, GL_LINEAR);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.check("making the texture of what is near the bone");
}

void NearStructurePainter::setUniforms(const Program& program, bool shows_thickness) const {
    gl_.bindTexture(kNearUnit, GL_TEXTURE_3D, texture_.name());
    program.set("near_structures", int(kNearUnit));
    for (int i = 0; i < kThicknessColours; ++i)
        program.set(("thickness_colours[" + std::to_string(i) + "]").c_str(), thicknessColours()[size_t(i)]);
    program.set("near_first", first_V_);
    program.set("near_extent", extent_);
    program.set("shine", Eigen::Vector4f(kMostShine, kShineLength, kShineReach, reach_));
    program.set("shows_thickness", shows_thickness ? 1 : 0);
}

BonePainter::BonePainter(const GlApi& gl)
    : gl_(gl),
      depth_(gl, "bone depth", shaders::kMeshVertex, shaders::kDepthFragment),
      surface_(gl, "bone's surface",
               std::string(MaterialPalette::kDefine) + "#define MILLED\n" + shaders::kMeshVertex,
               shaders::kBoneSurfaceFragment),
      cap_(gl, "cap", shaders::kFullScreenVertex, shaders::kCapFragment),
      no_attributes_(gl),
      palette_(std::make_unique<MaterialPalette>(gl, vertexColoursOf({}))) {}

void BonePainter::setPalette(const std::vector<Eigen::Vector4f>& colours) {
    palette_ = std::make_unique<MaterialPalette>(gl_, colours);
}

// Each combination of what bone shows has a program of its own, made when it is first seen.
const Program& BonePainter::shading(const SurfaceMaps& maps) {
    const bool has_samples = maps.samples() > 0;
    std::unique_ptr<Program>& program =
        shadings_[size_t(hasFilm() ? 1 : 0) + size_t(near_ ? 2 : 0) + size_t(has_samples ? 4 : 0)];
    if (program) return *program;
    const std::string words =
        std::string(hasFilm() ? "#define FILM\n" : "") + (near_ ? "#define NEAR_STRUCTURES\n" : "") +
        (has_samples ? "#define SAMPLES " + std::to_string(maps.samples()) + "\n" : std::string());
    program = std::make_unique<Program>(gl_, "bone", shaders::kFullScreenVertex,
                                        words + shaders::kBoneShadeFragment);
    return *program;
}

void BonePainter::drawOpaque(const Frame& frame, const NodeStore& nodes, const BoneLayer& layer,
                             const PixelBox& part, GLuint shadow_texture) {
    const Place place{{frame, layer, shadow_texture}, nodes};
    setScissor(gl_, part);
    clearMaps(layer);
    setScissor(gl_, part.grown(kScissorRim));
    if (frame.cuts_V.any()) beginMarking();
    drawSurface(place, {{1, 0}, kInsideSolid});
    if (!frame.cuts_V.any()) return;
    gl_.DepthFunc(GL_ALWAYS);  // at its rim the cap is as deep as the surface
    drawCap(place, 1);
    gl_.DepthFunc(GL_LESS);
}

void BonePainter::drawTransparent(const Frame& frame, const NodeStore& nodes, const BoneLayer& layer,
                                  GLuint shadow_texture, double opacity,
                                  const std::function<void()>& draw_tool) {
    const Place place{{frame, layer, shadow_texture}, nodes};
    drawFarWall(place);
    if (frame.cuts_V.any()) markOpened(place);
    draw_tool();
    drawInnerWall(place);
    findNearestLayer(place, GL_BACK);
    drawFoundLayer(place, {{float(opacity), kOutline}, kInsideGlass});
    if (!frame.cuts_V.any()) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.DepthFunc(GL_LEQUAL);
    drawCap(place, std::min(float(opacity) + kCapOpacity, 1.0f));
    gl_.DepthFunc(GL_LESS);
    gl_.Disable(GL_BLEND);
}

// Takes the surface as depth, faces and stencil are tested now. Leaves faces and stencil untested.
void BonePainter::drawSurface(const Place& place, const Look& look) {
    gather(place);
    gl_.Disable(GL_STENCIL_TEST);
    gl_.CullFace(GL_BACK);
    gl_.Disable(GL_CULL_FACE);
    blendShaded(prepareShading(place, look));
}

void BonePainter::shadeAgain(const Frame& frame, const BoneLayer& layer, GLuint shadow_texture,
                             const std::vector<PixelBox>& parts,
                             const std::function<void(const PixelBox&)>& draw_under) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, layer.picture);
    const Program& shading = prepareShading({frame, layer, shadow_texture}, {{1, 0}, kInsideSolid});
    for (const PixelBox& part : parts) {
        draw_under(part);
        setScissor(gl_, part);
        blendShaded(shading);
    }
}

void BonePainter::clearMaps(const BoneLayer& layer) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, layer.surface);
    layer.maps.clear();
    gl_.BindFramebuffer(GL_FRAMEBUFFER, layer.picture);
}

void BonePainter::gather(const Place& place) {
    const Frame& frame = place.frame;
    const ClipPlanes clip(gl_, frame.cuts_V);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, place.layer.surface);
    surface_.use();
    setCutPlanes(surface_, frame.cuts_V);
    surface_.set("camera_from_model", frame.X_CV);
    surface_.set("clip_from_camera", frame.clip_from_camera);
    palette_->setUniforms(surface_);
    triangles_drawn_ = place.nodes.draw(surface_, frame.cull_from_V);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, place.layer.picture);
}

const Program& BonePainter::prepareShading(const Canvas& canvas, const Look& look) {
    const Frame& frame = canvas.frame;
    const Program& shading = this->shading(canvas.layer.maps);
    shading.use();
    frame.setLight(gl_, shading, canvas.shadow_texture);
    canvas.layer.maps.setUniforms(shading);
    shading.set("tangents", frame.tangents);
    shading.set("shift", frame.shift);
    shading.set("model_from_camera", Eigen::Matrix4f(frame.X_CV.inverse()));
    shading.set("grain_size", float(kGrain) * frame.bone_radius);
    shading.set("opacity", look.opacity);
    shading.set("inside_colour", look.inside);
    shading.set("shows_scan", milled_grey_ ? 1 : 0);
    shading.set("grey_of_density", milled_grey_.value_or(Eigen::Vector2f::UnitX()));
    if (hasFilm()) film_->setUniforms(shading);
    if (near_) near_->setUniforms(shading, shows_thickness_);
    return shading;
}

void BonePainter::blendShaded(const Program& shading) const {
    shading.use();
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    drawFullScreen();
    gl_.Disable(GL_BLEND);
    gl_.Enable(GL_DEPTH_TEST);
}

void BonePainter::drawDepth(const Place& place) const {
    const Frame& frame = place.frame;
    const ClipPlanes clip(gl_, frame.cuts_V);
    depth_.use();
    setCutPlanes(depth_, frame.cuts_V);
    depth_.set("camera_from_model", frame.X_CV);
    depth_.set("clip_from_camera", frame.clip_from_camera);
    gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    place.nodes.draw(depth_, frame.cull_from_V);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

// Draws the farthest front face where there is another one before it: the far wall of a cavity, or of the
// skull. Leaves the depth clear, and in the stencil how many layers there are.
void BonePainter::drawFarWall(const Place& place) {
    gl_.ClearDepth(0);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
    gl_.ClearDepth(1);
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(GL_BACK);
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilMask(kLayers);
    gl_.StencilFunc(GL_ALWAYS, 0, kAllBits);
    gl_.StencilOp(GL_KEEP, GL_INCR, GL_INCR);
    gl_.DepthFunc(GL_GREATER);
    drawDepth(place);

    gl_.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    gl_.StencilMask(kAllBits);
    gl_.StencilFunc(GL_LEQUAL, 2, kLayers);
    drawFoundLayer(place, {{kFarWallOpacity, 0}, kInsideGlass});
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
}

// The wall is strong where it belongs to a cavity or something else is behind it: that is
// what one wants to see.
void BonePainter::drawInnerWall(const Place& place) {
    findNearestLayer(place, GL_FRONT);
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilFunc(GL_LEQUAL, 2, kLayers);
    drawFoundLayer(place, {{kWallOpacity, kOutline}, kInsideGlass});
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(GL_FRONT);
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilFunc(GL_GREATER, 2, kLayers);
    drawFoundLayer(place, {{kLastWallOpacity, 0}, kInsideGlass});
}

void BonePainter::findNearestLayer(const Place& place, GLenum culled) const {
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(culled);
    drawDepth(place);
}

// Culls as the layer was found, and leaves culling off.
void BonePainter::drawFoundLayer(const Place& place, const Look& look) {
    gl_.DepthFunc(GL_EQUAL);
    clearMaps(place.layer);
    drawSurface(place, look);
    gl_.DepthFunc(GL_LESS);
}

// From here on the stencil says which side of the nearest surface is seen.
void BonePainter::beginMarking() const {
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilMask(kOpened);
    gl_.StencilFunc(GL_ALWAYS, kOpened, kAllBits);
    gl_.StencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_ZERO);
    gl_.StencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_REPLACE);
}

void BonePainter::markOpened(const Place& place) const {
    beginMarking();
    drawDepth(place);
    gl_.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    gl_.StencilMask(kAllBits);
    gl_.Disable(GL_STENCIL_TEST);
    gl_.Clear(GL_DEPTH_BUFFER_BIT);
}

void BonePainter::drawCap(const Place& place, float opacity) const {
    const Frame& frame = place.frame;
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilFunc(GL_EQUAL, kOpened, kOpened);
    gl_.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    gl_.StencilMask(kAllBits);
    const Program& cap = faces_ ? faces_->cap() : cap_;
    cap.use();
    frame.setLight(gl_, cap, place.shadow_texture);
    setCutPlanes(cap, frame.cuts_C);
    cap.set("near_far", frame.near_far);
    cap.set("tangents", frame.tangents);
    cap.set("shift", frame.shift);
    cap.set("model_from_camera", Eigen::Matrix4f(frame.X_CV.inverse()));
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(kBoxMargin * frame.bone_radius);
    cap.set("bone_low", Eigen::Vector3f(frame.bone_V.min() - margin));
    cap.set("bone_high", Eigen::Vector3f(frame.bone_V.max() + margin));
    cap.set("grain_size", float(kGrain) * frame.bone_radius);
    cap.set("opacity", opacity);
    if (faces_) faces_->setUniforms();
    drawFullScreen();
    gl_.Disable(GL_STENCIL_TEST);
}

void BonePainter::drawFullScreen() const {
    gl_.BindVertexArray(no_attributes_.name());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    gl_.BindVertexArray(0);
}

}  // namespace bonemill
