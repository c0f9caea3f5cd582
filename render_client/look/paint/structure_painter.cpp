#include "render_client/look/paint/structure_painter.h"

#include <utility>

#include "render_client/look/model/mesh_difference.h"
#include "render_client/look/paint/clip_planes.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr GLuint kCount = 0x7f;  // of the stencil; the highest bit is the bone's
constexpr GLuint kAllStencil = 0xff;

}  // namespace

void StructurePainter::set(const NodeMesh& mesh) {
    if (!program_) {
        program_ =
            std::make_unique<Program>(gl_, "structure", shaders::kMeshVertex, shaders::kStructureFragment);
        section_ = std::make_unique<Program>(gl_, "section of a structure", shaders::kFullScreenVertex,
                                             shaders::kSectionFragment);
    }
    Shape shape{NodeStore(gl_), boxOf(mesh), {}};
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
        if (shape == shapes_.end() || shape->second.look == look) continue;
        shape->second.look = look;
        changed_.extend(shape->second.box);
    }
    return std::exchange(changed_, {});
}

void StructurePainter::draw(const Frame& frame, const std::vector<StructureLook>& looks,
                            GLuint shadow_texture) const {
    drawPart(frame, looks, shadow_texture, Part::kBehind);
    drawPart(frame, looks, shadow_texture, Part::kExposed);
    if (frame.cuts_V.any()) drawSections(frame, looks);
}

void StructurePainter::drawSolid(const Frame& frame, const std::vector<StructureLook>& looks,
                                 GLuint shadow_texture) const {
    drawPart(frame, looks, shadow_texture, Part::kExposed);
}

void StructurePainter::drawPart(const Frame& frame, const std::vector<StructureLook>& looks,
                                GLuint shadow_texture, Part part) const {
    if (shapes_.empty()) return;
    const ClipPlanes clip(gl_, frame.cuts_V);
    program_->use();
    frame.setLight(gl_, *program_, shadow_texture);
    setCutPlanes(*program_, frame.cuts_V);
    program_->set("camera_from_model", frame.X_CV);
    const bool is_behind = part == Part::kBehind;
    program_->set("is_behind", is_behind ? 1 : 0);
    if (is_behind) {
        gl_.Enable(GL_BLEND);
        gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        gl_.Enable(GL_CULL_FACE);
        gl_.CullFace(GL_BACK);
        gl_.DepthMask(GL_FALSE);
        gl_.DepthFunc(GL_GREATER);
    }
    for (const StructureLook& look : looks) {
        const auto shape = shapes_.find(look.structure);
        const bool is_shown =
            is_behind ? look.mode == StructureMode::kThroughBone : look.mode != StructureMode::kOff;
        if (shape == shapes_.end() || !is_shown) continue;
        program_->set("structure_colour", look.colour);
        program_->set("glow", look.glow);
        shape->second.surface.draw(*program_, frame.cull_from_V);
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
        section_->set("light_reach", frame.key.reach);
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
    shape.surface.draw(*program_, frame.cull_from_V);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_TRUE);
}

}  // namespace bonemill
