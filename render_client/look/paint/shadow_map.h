// What the key light sees: the nearest of bone and tool along it. While view and light rest, only what
// changed is drawn anew.
//
// It belongs to the thread of the context. The frames are V (volume), T (tool), C (camera) and the light's
// clip space; the units are m and texels.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/pixel_tiles.h"

namespace bonemill {

class ShadowMap {
  public:
    static constexpr int kSize = 2048;  // texels per side

    // With a size of 1 it is the texture that a sampler wants where there is no shadow. Throws GlError.
    ShadowMap(const GlApi& gl, int size);

    GLuint texture() const { return texture_.name(); }

    // Draws all anew, the bone only if it casts a shadow. This and update() want the scissor test enabled,
    // and leave the viewport the map's.
    void draw(const Frame& frame, const NodeStore& nodes, const ToolMesh& tool, bool has_bone);

    // Draws what changed since the last picture of the same view: bone within the box, and the tool. Returns
    // the boxes (the light's clip space) in which a surface may be in another shadow now.
    std::vector<Eigen::AlignedBox3f> update(const Frame& frame, const NodeStore& nodes, const ToolMesh& tool,
                                            const Eigen::AlignedBox3f& changed_V);

  private:
    struct Caster {
        PixelBox texels;
        float nearest;  // to the light, clip space
    };
    void makeMap(const GlFramebuffer& framebuffer, const GlTexture& texture) const;
    void drawBone(const Frame& frame, const NodeStore& nodes, const PixelBox& part) const;
    void drawTool(const Frame& frame, const ToolMesh& tool) const;
    void aim(const Frame& frame, const Eigen::Matrix4f& camera_from_model) const;
    void begin(GLuint framebuffer, const PixelBox& part) const;
    std::vector<Caster> toolIn(const Frame& frame, const ToolMesh& tool) const;
    Caster casterOf(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& shadow_from_model) const;
    Eigen::AlignedBox3f shadowedBy(const Caster& caster, const Frame& frame) const;

    const GlApi& gl_;
    int size_;
    Program program_;
    GlFramebuffer bone_framebuffer_, framebuffer_;
    GlTexture bone_texture_, texture_;  // without the tool, and with it
    std::vector<Caster> tool_;          // in the last picture
    std::vector<float> tool_like_;      // how it stood there
};

}  // namespace bonemill
