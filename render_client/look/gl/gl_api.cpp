#include "render_client/look/gl/gl_api.h"

namespace bonemill {

GlApi GlApi::load(const std::function<void*(const char*)>& address_of) {
    GlApi gl;
#define BONEMILL_GL_LOAD(type, name)                          \
    gl.name = reinterpret_cast<type>(address_of("gl" #name)); \
    if (!gl.name) throw GlError("OpenGL function gl" #name " is missing: 3.3 core is needed");
    BONEMILL_GL_FUNCTIONS(BONEMILL_GL_LOAD)
#undef BONEMILL_GL_LOAD
    return gl;
}

bool GlApi::isSoftware() const {
    const std::string renderer = describe();
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

std::string GlApi::describe() const {
    const auto text = [this](GLenum name) {
        const auto* value = reinterpret_cast<const char*>(GetString(name));
        return std::string(value ? value : "?");
    };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

void GlApi::check(const char* where) const {
    const GLenum code = GetError();
    if (code != GL_NO_ERROR) throw GlError("OpenGL error " + std::to_string(code) + " in " + where);
}

}  // namespace bonemill
