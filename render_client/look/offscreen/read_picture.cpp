#include "render_client/look/offscreen/read_picture.h"

#include <algorithm>

namespace bonemill {

Picture readPicture(const GlApi& gl, int width, int height) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.Finish();
    Picture picture(width, height);
    std::vector<uint8_t> row(size_t(width) * 3);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    for (int y = 0; y < height; ++y) {  // OpenGL counts rows from below
        gl.ReadPixels(0, height - 1 - y, width, 1, GL_RGB, GL_UNSIGNED_BYTE, row.data());
        std::copy(row.begin(), row.end(), picture.row(y));
    }
    gl.check("reading the picture");
    return picture;
}

}  // namespace bonemill
