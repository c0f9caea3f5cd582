// Copies what was drawn out of an OpenGL context. It belongs to the thread of the context, which
// must be current.
#pragma once

#include "common/picture/picture.h"
#include "render_client/look/gl/gl_api.h"

namespace bonemill {

// Waits for the drawing and copies the default framebuffer of this size (pixels). Throws GlError.
Picture readPicture(const GlApi& gl, int width, int height);

}  // namespace bonemill
