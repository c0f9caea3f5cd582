#include "render_client/look/gl/gl_api.h"

#include <vector>

namespace bonemill {
namespace {

constexpr char kVersionLine[] = "#version 330 core\n";

class Shader {
  public:
    Shader(const GlApi& gl, GLenum stage, const std::string& program_name, const std::string& source)
        : gl_(gl), name_(gl.CreateShader(stage)) {
        const char* parts[] = {kVersionLine, source.c_str()};
        gl_.ShaderSource(name_, 2, parts, nullptr);
        gl_.CompileShader(name_);
        GLint compiled = 0;
        gl_.GetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
        if (compiled) return;
        const char* stage_name = stage == GL_VERTEX_SHADER ? "vertex" : "fragment";
        const std::string message = "shader " + program_name + " (" + stage_name + "): " + log();
        gl_.DeleteShader(name_);
        throw GlError(message);
    }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { gl_.DeleteShader(name_); }
    GLuint name() const { return name_; }

  private:
    std::string log() const {
        GLint length = 0;
        gl_.GetShaderiv(name_, GL_INFO_LOG_LENGTH, &length);
        std::vector<char> text(size_t(length) + 1, '\0');
        gl_.GetShaderInfoLog(name_, GLsizei(text.size()), nullptr, text.data());
        return text.data();
    }

    const GlApi& gl_;
    GLuint name_;
};

}  // namespace

Program::Program(const GlApi& gl, const std::string& name, const std::string& vertex_source,
                 const std::string& fragment_source)
    : gl_(gl) {
    const Shader vertex(gl, GL_VERTEX_SHADER, name, vertex_source);
    const Shader fragment(gl, GL_FRAGMENT_SHADER, name, fragment_source);
    program_ = gl.CreateProgram();
    gl.AttachShader(program_, vertex.name());
    gl.AttachShader(program_, fragment.name());
    gl.LinkProgram(program_);
    GLint linked = 0;
    gl.GetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked) return;
    GLint length = 0;
    gl.GetProgramiv(program_, GL_INFO_LOG_LENGTH, &length);
    std::vector<char> log(size_t(length) + 1, '\0');
    gl.GetProgramInfoLog(program_, GLsizei(log.size()), nullptr, log.data());
    gl.DeleteProgram(program_);
    throw GlError("shader program " + name + ": " + log.data());
}

Program::~Program() {
    gl_.DeleteProgram(program_);
}

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

void GlApi::setSampling(GLenum target, GLint filter, GLint wrap) const {
    for (const GLenum scaled : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        TexParameteri(target, scaled, filter);
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        TexParameteri(target, direction, wrap);
}

void GlApi::bindTexture(GLenum unit, GLenum target, GLuint texture) const {
    ActiveTexture(GL_TEXTURE0 + unit);
    BindTexture(target, texture);
    ActiveTexture(GL_TEXTURE0);
}

void GlApi::setFloats(GLuint attribute, GLint floats, size_t stride, size_t offset) const {
    VertexAttribPointer(attribute, floats, GL_FLOAT, GL_FALSE, GLsizei(stride),
                        reinterpret_cast<const void*>(offset));
    EnableVertexAttribArray(attribute);
}

void GlApi::check(const char* where) const {
    const GLenum code = GetError();
    if (code != GL_NO_ERROR) throw GlError("OpenGL error " + std::to_string(code) + " in " + where);
}

}  // namespace bonemill
