#include "render_client/look/model/material_palette.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kGamma = 2.2;  // as toneMap() of the shaders
constexpr GLsizei kMaxColours = 256;
const Eigen::Vector3f kPlainBone(0.755f, 0.63f, 0.46f);  // the middle of the bone shader's mottling

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
        colours.push_back(material.has_color() ? linear(material.color()) : Eigen::Vector4f::Zero());
    return colours;
}

std::array<Eigen::Vector3f, 256> boneColoursOf(const std::vector<Eigen::Vector4f>& palette) {
    std::array<Eigen::Vector3f, 256> colours;
    colours.fill(kPlainBone);
    for (size_t i = 0; i < std::min(palette.size(), colours.size()); ++i)
        colours[i] = palette[i].head<3>() + (1 - palette[i].w()) * kPlainBone;
    return colours;
}

// All 256 texels are filled: a vertex may name a material that the scene does not have.
MaterialPalette::MaterialPalette(const GlApi& gl, const std::vector<Eigen::Vector4f>& colours)
    : gl_(gl), texture_(gl) {
    std::vector<Eigen::Vector4f> texels = colours;
    texels.resize(kMaxColours, Eigen::Vector4f::Zero());
    gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
    gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, kMaxColours, 1, 0, GL_RGBA, GL_FLOAT, texels.data());
    gl_.setSampling(GL_TEXTURE_2D, GL_NEAREST, GL_REPEAT);
    gl_.ActiveTexture(GL_TEXTURE0);
}

void MaterialPalette::setUniforms(const Program& program) const {
    gl_.bindTexture(kUnit, GL_TEXTURE_2D, texture_.name());
    program.set("palette", kUnit);
}

}  // namespace bonemill
