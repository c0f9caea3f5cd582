#include "render_client/look/paint/structure_painter.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "render_client/look/model/node_store.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr float kHalfLine = 0.0022f;  // picture heights
constexpr float kHalfDot = 0.0065f;

constexpr GLuint kCount = 0x7f;  // of the stencil; the highest bit is the bone's
constexpr GLuint kAllStencil = 0xff;

}  // namespace

StrokePainter::StrokePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "stroke", shaders::kStrokeVertex, shaders::kStrokeFragment),
      layout_(gl),
      buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    // A line goes from a point to the one after it.
    gl_.setFloats(0, 3, sizeof(Point), offsetof(Point, p_W));
    gl_.setFloats(1, 3, sizeof(Point), sizeof(Point) + offsetof(Point, p_W));
    gl_.setFloats(2, 3, sizeof(Point), offsetof(Point, colour));
    gl_.setFloats(3, 1, sizeof(Point), offsetof(Point, half_width));
    for (GLuint i = 0; i < 4; ++i) gl_.VertexAttribDivisor(i, 1);
    gl_.BindVertexArray(0);
}

void StrokePainter::set(const std::vector<Stroke>& strokes) {
    if (strokes.empty() && lines_ == 0) return;
    std::vector<Point> points;
    for (const Stroke& stroke : strokes) {
        for (const Eigen::Vector3f& p_W : stroke.points_W) points.push_back({p_W, stroke.colour, kHalfLine});
        if (stroke.points_W.size() == 1) points.push_back({stroke.points_W[0], stroke.colour, kHalfLine});
        if (stroke.points_W.size() == 1) points[points.size() - 2].half_width = kHalfDot;
        if (!stroke.points_W.empty()) points.back().half_width = 0;
    }
    lines_ = GLsizei(points.empty() ? 0 : points.size() - 1);
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * sizeof(Point)), points.data(),
                   GL_DYNAMIC_DRAW);
}

void StrokePainter::draw(const Frame& frame, const FrameView& view) const {
    if (lines_ == 0) return;
    const ClipPlanes clip(gl_, frame.cuts_C);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthMask(GL_FALSE);
    program_.use();
    program_.set("camera_from_world", view.camera.X_CW());
    program_.set("clip_from_camera", frame.clip_from_camera);
    program_.set("height_per_depth", 2 * frame.tangents.y());
    program_.set("nearest", frame.near_far.x());
    setCutPlanes(program_, frame.cuts_C);
    gl_.BindVertexArray(layout_.name());
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines_);
    gl_.BindVertexArray(0);
    gl_.DepthMask(GL_TRUE);
}

Eigen::AlignedBox3f StrokePainter::box(const Stroke& stroke, const Frame& frame, const FrameView& view) {
    Eigen::AlignedBox3f box;
    const Eigen::Matrix4f X_CW = view.camera.X_CW();
    for (const Eigen::Vector3f& p_W : stroke.points_W) {
        const Eigen::Vector3f p_C = (X_CW * p_W.homogeneous()).head<3>();
        const float room = 3 * kHalfDot * 2 * frame.tangents.y() * std::max(-p_C.z(), 0.0f);
        box.extend(Eigen::Vector3f(p_C.array() - room));
        box.extend(Eigen::Vector3f(p_C.array() + room));
    }
    return box;
}

void StructurePainter::set(const NodeMesh& mesh) {
    if (!program_) {
        const std::string vertex = std::string("#define PULSE\n") + shaders::kMeshVertex;
        program_ = std::make_unique<Program>(gl_, "structure", vertex, shaders::kStructureFragment);
        bruised_ = std::make_unique<Program>(gl_, "bruised structure", vertex,
                                             std::string("#define FILM\n") + shaders::kStructureFragment);
        section_ = std::make_unique<Program>(gl_, "section of a structure", shaders::kFullScreenVertex,
                                             shaders::kSectionFragment);
    }
    Shape shape{NodeStore(gl_), boxOf(mesh), {}, GlQuery(gl_)};
    shape.surface.set(mesh);
    changed_.extend(shape.box);
    shapes_.erase(mesh.leaf);
    shapes_.emplace(mesh.leaf, std::move(shape));
}

void StructurePainter::clear() {
    for (const auto& [id, shape] : shapes_) changed_.extend(shape.box);
    shapes_.clear();
}

Eigen::AlignedBox3f StructurePainter::takeChanged(const std::vector<StructureLook>& looks) {
    for (const StructureLook& look : looks) {
        const auto shape = shapes_.find(look.structure);
        if (shape == shapes_.end()) continue;
        Shape& drawn = shape->second;
        StructureLook next = look;
        if (!isSeen(drawn)) next.rise = drawn.look.rise;
        drawn.is_whole = std::exchange(drawn.look, next) != next;
        if (drawn.is_whole) changed_.extend(drawn.box);
    }
    return std::exchange(changed_, {});
}

// A part of the picture tells what is seen, and only the whole of it what is not.
bool StructurePainter::isSeen(Shape& shape) const {
    if (!std::exchange(shape.is_asked, false)) return shape.is_seen;
    GLuint any = 0;
    gl_.GetQueryObjectuiv(shape.sight.name(), GL_QUERY_RESULT, &any);
    shape.is_seen = any != 0 || (shape.is_seen && !shape.is_whole);
    return shape.is_seen;
}

void StructurePainter::draw(const Frame& frame, const std::vector<StructureLook>& looks,
                            GLuint shadow_texture) const {
    drawPart(frame, looks, shadow_texture, Part::kBehind);
    drawPart(frame, looks, shadow_texture, Part::kExposed);
    if (frame.cuts_V.any()) drawSections(frame, looks);
}

void StructurePainter::drawAgain(const Frame& frame, const std::vector<StructureLook>& looks,
                                 GLuint shadow_texture) const {
    drawPart(frame, looks, shadow_texture, Part::kExposedAgain);
}

void StructurePainter::drawSolid(const Frame& frame, const std::vector<StructureLook>& looks,
                                 GLuint shadow_texture) const {
    drawPart(frame, looks, shadow_texture, Part::kExposed);
}

void StructurePainter::drawPart(const Frame& frame, const std::vector<StructureLook>& looks,
                                GLuint shadow_texture, Part part) const {
    if (shapes_.empty()) return;
    const ClipPlanes clip(gl_, frame.cuts_V);
    const Program& surface = this->surface();
    surface.use();
    frame.setLight(gl_, surface, shadow_texture);
    setCutPlanes(surface, frame.cuts_V);
    if (film_) film_->setUniforms(surface);
    surface.set("camera_from_model", frame.X_CV);
    const bool is_behind = part == Part::kBehind;
    surface.set("is_behind", is_behind ? 1 : 0);
    if (is_behind) {
        gl_.Enable(GL_BLEND);
        gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        gl_.Enable(GL_CULL_FACE);
        gl_.CullFace(GL_BACK);
        gl_.DepthMask(GL_FALSE);
    }
    gl_.DepthFunc(is_behind ? GL_GREATER : GL_LEQUAL);  // the layer may have it already
    for (const StructureLook& look : looks) {
        const auto shape = shapes_.find(look.structure);
        const bool is_shown =
            is_behind ? look.mode == StructureMode::kThroughBone : look.mode != StructureMode::kOff;
        if (shape == shapes_.end() || !is_shown) continue;
        const bool is_hidden = !shape->second.is_seen && !shape->second.is_asked;
        if (part == Part::kExposedAgain && is_hidden) continue;
        surface.set("structure_colour", look.colour);
        surface.set("glow", look.glow);
        surface.set("rise", is_behind ? 0.0f : look.rise);
        const bool asks = part == Part::kExposed;
        if (asks) gl_.BeginQuery(GL_ANY_SAMPLES_PASSED, shape->second.sight.name());
        shape->second.surface.draw(surface, frame.cull_from_V);
        if (asks) gl_.EndQuery(GL_ANY_SAMPLES_PASSED);
        shape->second.is_asked |= asks;
    }
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
}

// A ray that leaves a closed body once more than it enters it was in the body already when it came through
// the cut-planes. Nothing that is shown lies before that place.
void StructurePainter::drawSections(const Frame& frame, const std::vector<StructureLook>& looks) const {
    gl_.Enable(GL_STENCIL_TEST);
    gl_.StencilMask(kCount);
    for (const StructureLook& look : looks) {
        const auto shape = shapes_.find(look.structure);
        if (shape == shapes_.end() || look.mode == StructureMode::kOff) continue;
        countFaces(frame, shape->second);
        gl_.StencilFunc(GL_EQUAL, 1, kCount);
        gl_.StencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
        section_->use();
        setCutPlanes(*section_, frame.cuts_C);
        section_->set("near_far", frame.near_far);
        section_->set("tangents", frame.tangents);
        section_->set("shift", frame.shift);
        section_->set("clip_from_camera", frame.clip_from_camera);
        frame.setStrength(*section_);
        section_->set("structure_colour", look.colour);
        section_->set("glow", look.glow);
        gl_.BindVertexArray(no_attributes_.name());
        gl_.DrawArrays(GL_TRIANGLES, 0, 3);
        gl_.BindVertexArray(0);
    }
    gl_.DepthFunc(GL_LESS);
    gl_.StencilMask(kAllStencil);
    gl_.Disable(GL_STENCIL_TEST);
}

// Leaves in the stencil how many more back faces there are than front faces.
void StructurePainter::countFaces(const Frame& frame, const Shape& shape) const {
    gl_.Clear(GL_STENCIL_BUFFER_BIT);
    gl_.StencilFunc(GL_ALWAYS, 0, kCount);
    gl_.StencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_DECR_WRAP);
    gl_.StencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_INCR_WRAP);
    gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gl_.DepthMask(GL_FALSE);
    gl_.DepthFunc(GL_ALWAYS);
    const ClipPlanes clip(gl_, frame.cuts_V);
    program_->use();
    program_->set("rise", shape.look.rise);
    shape.surface.draw(*program_, frame.cull_from_V);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_TRUE);
}

}  // namespace bonemill
