#include "render_client/panel/imgui/imgui_painter.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bonemill {
namespace {

constexpr char kVertexShader[] = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
uniform vec2 size;
out vec2 font_uv;
out vec4 tint;
void main() {
    font_uv = uv;
    tint = colour;
    gl_Position = vec4(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y, 0.0, 1.0);
}
)";

constexpr char kFragmentShader[] = R"(
in vec2 font_uv;
in vec4 tint;
uniform sampler2D font;
uniform bool is_picture;
out vec4 colour;
void main() {
    vec4 texel = texture(font, font_uv);
    colour = is_picture ? tint * texel : vec4(tint.rgb, tint.a * texel.r);
}
)";

}  // namespace

ImGuiPainter::ImGuiPainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "panel", kVertexShader, kFragmentShader),
      layout_(gl),
      vertices_(gl),
      indices_(gl),
      font_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    const auto attribute = [&](GLuint index, GLint size, GLenum type, GLboolean is_normalised,
                               size_t offset) {
        gl_.VertexAttribPointer(index, size, type, is_normalised, sizeof(ImDrawVert),
                                reinterpret_cast<const void*>(offset));
        gl_.EnableVertexAttribArray(index);
    };
    attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
    attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
    attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
    gl_.BindVertexArray(0);
}

void ImGuiPainter::smooth() {
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void ImGuiPainter::uploadFont(const ImGuiStage::FontPixels& font) {
    gl_.BindTexture(GL_TEXTURE_2D, font_.name());
    if (font.version == font_version_) return;
    font_version_ = font.version;
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, font.width, font.height, 0, GL_RED, GL_UNSIGNED_BYTE,
                   font.pixels);
    smooth();
}

void ImGuiPainter::prepare(int width, int height) {
    gl_.Viewport(0, 0, width, height);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_BLEND);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.use();
    program_.set("size", Eigen::Vector2f(float(width), float(height)));
    program_.set("font", 0);
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
}

void ImGuiPainter::paint(const ImDrawData& drawing, const ImGuiStage::FontPixels& font,
                         const ImGuiTextures& textures, int width, int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    uploadFont(font);
    prepare(width, height);
    for (int i = 0; i < drawing.CmdListsCount; ++i) {
        const ImDrawList& list = *drawing.CmdLists[i];
        gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
        gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                       GL_STREAM_DRAW);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            const float left = std::max(clip.x, 0.f), right = std::min(clip.z, float(width));
            const float top = std::max(clip.y, 0.f), bottom = std::min(clip.w, float(height));
            if (right <= left || bottom <= top) continue;
            gl_.Scissor(GLint(left), GLint(float(height) - bottom), GLsizei(right - left),
                        GLsizei(bottom - top));
            const auto picture = textures.find(int(intptr_t(command.GetTexID())));
            program_.set("is_picture", int(picture != textures.end()));
            gl_.BindTexture(GL_TEXTURE_2D, picture != textures.end() ? picture->second : font_.name());
            static_assert(sizeof(ImDrawIdx) == 2);
            gl_.DrawElements(GL_TRIANGLES, GLsizei(command.ElemCount), GL_UNSIGNED_SHORT,
                             reinterpret_cast<const void*>(size_t(command.IdxOffset) * sizeof(ImDrawIdx)));
        }
    }
    gl_.BindVertexArray(0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.check("drawing the control panel");
}

}  // namespace bonemill
