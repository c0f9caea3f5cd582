// The colours of a scene's materials, as the bone's shader looks them up. Only exists where a material has
// one.
//
// Thread: the one of the context.
#pragma once

#include <vector>

#include "proto/topics.pb.h"
#include "render_client/gl/gl_object.h"
#include "render_client/gl/program.h"

namespace bonemill {

// By material (0: none): linear colour times alpha, alpha; 0 where it has no colour. Empty: none has.
std::vector<Eigen::Vector4f> paletteOf(const topics::SceneInfo& info);

class MaterialPalette {
  public:
    // What goes before both shaders of a program that uses the palette.
    static constexpr char kDefine[] = "#define MATERIALS\n";

    // At most 256 colours, not empty.
    MaterialPalette(const GlApi& gl, const std::vector<Eigen::Vector4f>& colours);

    // The program must be in use.
    void setUniforms(const Program& program) const;

  private:
    static constexpr GLint kUnit = 2;  // 0: shadow map

    const GlApi& gl_;
    GlTexture texture_;
};

}  // namespace bonemill
