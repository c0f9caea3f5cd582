#include "render_client/look/model/material_palette.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/node_mesh.h"
#include "render_client/look/hud/palette.h"

namespace bonemill {
namespace {

constexpr double kGamma = 2.2;     // as toneMap() of the shaders
constexpr GLsizei kColours = 256;  // a vertex may name a material that the scene does not have
const Eigen::Vector3f kPlainBone(0.755f, 0.63f, 0.46f);  // the middle of the bone shader's mottling

// Milled bone is of the colour of its dust, which lies in its pores; some of what it is made of is left to
// see.
const Eigen::Vector3f kBoneDust(0.84f, 0.79f, 0.70f);
constexpr float kPaler = 0.5f;
const Eigen::Vector3f kBloodshot(0.42f, 0.02f, 0.02f);
constexpr float kRedder = 0.92f;

Eigen::Vector4f linear(const scene::Color& color) {
    const auto channel = [](double value) { return float(std::pow(std::clamp(value, 0.0, 1.0), kGamma)); };
    return {channel(color.red()), channel(color.green()), channel(color.blue()), 1};
}

}  // namespace

std::vector<Eigen::Vector4f> paletteOf(const topics::SceneInfo& info) {
    const auto& materials = info.materials();
    if (std::ranges::none_of(materials, [](const auto& m) { return m.has_color(); })) return {};
    std::vector<Eigen::Vector4f> colours{Eigen::Vector4f::Zero()};
    for (const scene::Material& material : materials)
        colours.push_back(material.has_color() ? linear(shownColour(material.color()))
                                               : Eigen::Vector4f::Zero());
    return colours;
}

std::vector<Eigen::Vector4f> vertexColoursOf(const topics::SceneInfo& info) {
    std::vector<Eigen::Vector4f> colours = paletteOf(info);
    colours.resize(kColours, Eigen::Vector4f::Zero());
    for (size_t n = 0; n < kMilledBit; ++n) {
        const bool is_cut =
            n > 0 && n <= size_t(info.materials_size()) && info.materials(int(n) - 1).is_protected();
        const Eigen::Vector3f over = is_cut ? kBloodshot : kBoneDust;
        const float share = is_cut ? kRedder : kPaler;
        Eigen::Vector4f& milled = colours[n | kMilledBit];
        milled.head<3>() = colours[n].head<3>() + share * (over - colours[n].head<3>());
        milled.w() = colours[n].w() + share * (1 - colours[n].w());
    }
    return colours;
}

std::array<Eigen::Vector3f, 256> boneColoursOf(const std::vector<Eigen::Vector4f>& palette) {
    std::array<Eigen::Vector3f, 256> colours;
    colours.fill(kPlainBone);
    for (size_t i = 0; i < std::min(palette.size(), colours.size()); ++i)
        colours[i] = palette[i].head<3>() + (1 - palette[i].w()) * kPlainBone;
    return colours;
}

MaterialPalette::MaterialPalette(const GlApi& gl, const std::vector<Eigen::Vector4f>& colours)
    : gl_(gl), texture_(gl) {
    gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
    gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, kColours, 1, 0, GL_RGBA, GL_FLOAT, colours.data());
    gl_.setSampling(GL_TEXTURE_2D, GL_NEAREST, GL_REPEAT);
    gl_.ActiveTexture(GL_TEXTURE0);
}

void MaterialPalette::setUniforms(const Program& program) const {
    gl_.bindTexture(kUnit, GL_TEXTURE_2D, texture_.name());
    program.set("palette", kUnit);
}

}  // namespace bonemill
