#include "render_client/look/offscreen/osmesa_context.h"

#include <GL/osmesa.h>

#include <algorithm>
#include <string>

#ifdef __SANITIZE_ADDRESS__
// Mesa keeps about a kilobyte for the process.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOSMesa.so\n";
}
#endif

namespace bonemill {
namespace {

OSMesaContext makeContext() {
    constexpr int kAttributes[] = {OSMESA_FORMAT,
                                   OSMESA_RGBA,
                                   OSMESA_DEPTH_BITS,
                                   24,
                                   OSMESA_PROFILE,
                                   OSMESA_CORE_PROFILE,
                                   OSMESA_CONTEXT_MAJOR_VERSION,
                                   3,
                                   OSMESA_CONTEXT_MINOR_VERSION,
                                   3,
                                   0};
    OSMesaContext context = OSMesaCreateContextAttribs(kAttributes, nullptr);
    if (!context) throw GlError("OSMesa cannot make an OpenGL 3.3 core context: is libosmesa6 complete?");
    return context;
}

}  // namespace

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

OsmesaContext::OsmesaContext(int width, int height)
    : width_(width), height_(height), context_(makeContext()), buffer_(size_t(width) * size_t(height) * 4) {
    if (!OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), buffer_.data(), GL_UNSIGNED_BYTE, width,
                           height)) {
        OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
        throw GlError("OSMesa refuses a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels");
    }
    gl_ = GlApi::load([](const char* name) { return reinterpret_cast<void*>(OSMesaGetProcAddress(name)); });
}

OsmesaContext::~OsmesaContext() {
    OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

Picture OsmesaContext::read() const {
    return readPicture(gl_, width_, height_);
}

}  // namespace bonemill
