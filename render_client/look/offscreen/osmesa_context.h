// Pictures out of OpenGL, also without a display. All belongs to the thread of the context.
#pragma once

#include <cstdint>
#include <vector>

#include "common/picture/picture.h"
#include "render_client/look/gl/gl_api.h"

namespace bonemill {

// Waits for the drawing and copies the default framebuffer of this size (pixels) out of the current context.
// Throws GlError.
Picture readPicture(const GlApi& gl, int width, int height);

// It is an OpenGL 3.3 core context in memory, which needs no display and no graphics card (Mesa's software
// renderer). There is one at a time per thread.
class OsmesaContext {
  public:
    // Makes the context current, with a default framebuffer of this size (pixels). Throws GlError.
    OsmesaContext(int width, int height);
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;
    ~OsmesaContext();

    const GlApi& gl() const { return gl_; }
    int width() const { return width_; }
    int height() const { return height_; }

    // Waits for the drawing and copies the default framebuffer.
    Picture read() const;

  private:
    int width_;
    int height_;
    void* context_;
    std::vector<uint8_t> buffer_;
    GlApi gl_;
};

}  // namespace bonemill
