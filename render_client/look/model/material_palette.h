// The bone's shader looks up here how a vertex looks by NodeMesh::materials: as its material in the scene
// does, or, where milling opened the bone, as fresh bone of it.
//
// It belongs to the thread of the context.
#pragma once

#include <array>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/gl/gl_api.h"

namespace bonemill {

// Returns, by material (0 is none), linear colour times alpha, and alpha; all 0 where it has no colour. The
// list is empty where no material has one.
std::vector<Eigen::Vector4f> paletteOf(const topics::SceneInfo& info);

// Returns the same by all of a vertex' number. With kMilledBit bone is paler, whatever it is made of, and a
// protected structure is red: it was cut.
std::vector<Eigen::Vector4f> vertexColoursOf(const topics::SceneInfo& info);

// Returns the linear colour of bone by material: of one without a colour that of plain bone.
std::array<Eigen::Vector3f, 256> boneColoursOf(const std::vector<Eigen::Vector4f>& palette);

class MaterialPalette {
  public:
    // This goes before the vertices' shader of a program that uses the palette.
    static constexpr char kDefine[] = "#define MATERIALS\n";

    // Takes vertexColoursOf() a scene.
    MaterialPalette(const GlApi& gl, const std::vector<Eigen::Vector4f>& colours);

    // The program must be in use.
    void setUniforms(const Program& program) const;

  private:
    static constexpr GLint kUnit = 2;  // 0: shadow map

    const GlApi& gl_;
    GlTexture texture_;
};

}  // namespace bonemill
