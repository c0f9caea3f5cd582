#include "render_client/panel/panel/panel_painter.h"

#include <set>

namespace bonemill {

void PanelPainter::uploadPictures(const Panel& panel) {
    std::set<int> wanted;
    for (const auto& [id, picture] : panel.pictures()) {
        if (picture.number == 0) continue;
        wanted.insert(picture.number);
        if (pictures_.contains(picture.number)) continue;
        GlTexture& texture = pictures_.try_emplace(picture.number, gl_).first->second;
        gl_.BindTexture(GL_TEXTURE_2D, texture.name());
        gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.pixels.width, picture.pixels.height, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, picture.pixels.rgba.data());
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
        for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
            gl_.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    }
    std::erase_if(pictures_, [&](const auto& entry) { return !wanted.contains(entry.first); });
}

void PanelPainter::paint(const Panel& panel, int width, int height) {
    const ImDrawData* const drawing = panel.drawData();
    if (!drawing) return;
    gl_.ActiveTexture(GL_TEXTURE0);
    uploadPictures(panel);
    ImGuiTextures textures;
    for (const auto& [number, texture] : pictures_) textures[number] = texture.name();
    painter_.paint(*drawing, panel.fontPixels(), textures, width, height);
}

}  // namespace bonemill
