#include "tests/gl/altered_shaders.h"

namespace bonemill::test {
namespace {

PFNGLSHADERSOURCEPROC real_shader_source = nullptr;
std::vector<Alteration> wanted;
int done = 0;

void APIENTRY shaderSource(GLuint shader, GLsizei count, const GLchar* const* parts, const GLint*) {
    std::string text;
    for (GLsizei i = 0; i < count; ++i) text += parts[i];
    for (const Alteration& alteration : wanted) {
        for (size_t at = text.find(alteration.what); at != std::string::npos;
             at = text.find(alteration.what, at + alteration.by.size())) {
            text.replace(at, alteration.what.size(), alteration.by);
            ++done;
        }
    }
    const GLchar* whole = text.c_str();
    real_shader_source(shader, 1, &whole, nullptr);
}

}  // namespace

GlApi alterShaders(const GlApi& gl, std::vector<Alteration> alterations) {
    real_shader_source = gl.ShaderSource;
    wanted = std::move(alterations);
    done = 0;
    GlApi altered = gl;
    altered.ShaderSource = shaderSource;
    return altered;
}

GlApi withoutAntialiasing(const GlApi& gl) {
    static PFNGLGETINTEGERVPROC real_get = nullptr;
    real_get = gl.GetIntegerv;
    GlApi altered = gl;
    altered.GetIntegerv = [](GLenum name, GLint* value) {
        real_get(name, value);
        if (name == GL_MAX_SAMPLES) *value = 0;
    };
    return altered;
}

int alterationsDone() {
    return done;
}

}  // namespace bonemill::test
