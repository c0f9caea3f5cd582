// Switches OpenGL's clip planes on for as long as it lives.
//
// It belongs to the thread of the context.
#pragma once

#include <array>

#include "render_client/look/camera/cut_planes.h"
#include "render_client/look/gl/program.h"

namespace bonemill {

class ClipPlanes {
  public:
    ClipPlanes(const GlApi& gl, const CutPlanes& cuts) : gl_(gl), is_on_(cuts.is_on) {
        for (GLenum i = 0; i < is_on_.size(); ++i)
            if (is_on_[i]) gl_.Enable(GL_CLIP_DISTANCE0 + i);
    }
    ClipPlanes(const ClipPlanes&) = delete;
    ClipPlanes& operator=(const ClipPlanes&) = delete;
    ~ClipPlanes() {
        for (GLenum i = 0; i < is_on_.size(); ++i)
            if (is_on_[i]) gl_.Disable(GL_CLIP_DISTANCE0 + i);
    }

  private:
    const GlApi& gl_;
    std::array<bool, CutPlanes::kMax> is_on_;
};

// Sets the uniforms of the mesh shaders.
inline void setCutPlanes(const Program& program, const CutPlanes& cuts_model) {
    program.set("cut_planes[0]", cuts_model.planes[0]);
    program.set("cut_planes[1]", cuts_model.planes[1]);
    program.set("cut_planes[2]", cuts_model.planes[2]);
}

}  // namespace bonemill
