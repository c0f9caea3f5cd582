#include "render_client/start_window/start_screen/start_painter.h"

namespace bonemill {

void StartPainter::upload(const CardPictures& pictures) {
    for (const auto& [file, picture] : pictures.all()) {
        if (picture.number == 0 || textures_.contains(picture.number)) continue;
        gl_.BindTexture(GL_TEXTURE_2D, textures_.try_emplace(picture.number, gl_).first->second.name());
        gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.pixels.width, picture.pixels.height, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, picture.pixels.rgba.data());
        gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
    }
}

void StartPainter::paint(const StartScreen& screen, int width, int height) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.ClearColor(0.06f, 0.075f, 0.09f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.ActiveTexture(GL_TEXTURE0);
    upload(screen.pictures());
    ImGuiTextures textures;
    for (const auto& [number, texture] : textures_) textures[number] = texture.name();
    painter_.paint(*screen.stage().drawData(), screen.stage().fontPixels(), textures, width, height);
}

}  // namespace bonemill
